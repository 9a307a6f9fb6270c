//! A curved mesh laid into the plane by its texture.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use super::chart::{Chart, border_length};
use crate::fabric::mesh::{RestMesh, Surface};

/// Greatest square of a length in the cloth over that in the texture, and one over the least, both in units of the
/// mesh's mean. Larger: cells that are no rectangles at rest are sheared to rectangles.
const DISTORTION: f32 = 1.6;

/// Part of a mesh's area that may be distorted more. Smaller: slivers, as at the tips of pennants, tell of the whole mesh. Larger:
/// cells that are no rectangles are sheared to rectangles.
const MOST_UNLIKE: f32 = 0.01;

/// Places in the texture that triangles use, in one connected piece.
struct Places {
    uv: Vec<Vec2>,
    /// The particle at each place.
    particles: Vec<u32>,
    /// Three places for each triangle of the mesh.
    triangles: Vec<[u32; 3]>,
}

impl Places {
    /// The places of a mesh's texture; none if it has several pieces. The two sides of a seam are different places.
    fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let mut numbers = BTreeMap::new();
        let mut places = Self { uv: Vec::new(), particles: Vec::new(), triangles: Vec::new() };
        for (corners, uv) in mesh.triangles.iter().zip(&surface.corner_uv) {
            let triangle = [0, 1, 2].map(|at| {
                let key = (corners[at], uv[at].to_array().map(f32::to_bits));
                *numbers.entry(key).or_insert_with(|| {
                    places.uv.push(uv[at]);
                    places.particles.push(corners[at]);
                    places.uv.len() as u32 - 1
                })
            });
            places.triangles.push(triangle);
        }
        places.is_connected().then_some(places)
    }

    fn is_connected(&self) -> bool {
        let mut neighbours = vec![Vec::new(); self.uv.len()];
        for &[a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                neighbours[from as usize].push(to);
                neighbours[to as usize].push(from);
            }
        }
        let mut is_reached = vec![false; self.uv.len()];
        let mut next = vec![0];
        while let Some(place) = next.pop() {
            if !core::mem::replace(&mut is_reached[place as usize], true) {
                next.extend(&neighbours[place as usize]);
            }
        }
        is_reached.into_iter().all(|reached| reached)
    }
}

/// Scalar products of the derivatives of position by u and v within a triangle: u u, u v, v v; none if the texture has
/// no area there. The sign is that of the texture's winding.
fn metric([a, b, c]: [Vec3; 3], [uv_a, uv_b, uv_c]: [Vec2; 3]) -> Option<([f32; 3], f32)> {
    let (e1, e2) = (b - a, c - a);
    let (t1, t2) = (uv_b - uv_a, uv_c - uv_a);
    let determinant = t1.perp_dot(t2);
    let by_u = (e1 * t2.y - e2 * t1.y) / determinant;
    let by_v = (e2 * t1.x - e1 * t2.x) / determinant;
    let products = [by_u.dot(by_u), by_u.dot(by_v), by_v.dot(by_v)];
    products.iter().all(|product| product.is_finite()).then_some((products, determinant.signum()))
}

impl Chart {
    /// The chart of a mesh by its texture, whose first axis is the warp; none if the texture has several pieces, shows
    /// a back, or distorts the mesh.
    pub(super) fn by_texture(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let scale = scale_of_texture(mesh, surface, &surface.corner_uv)?;
        let Places { uv, particles, triangles } = Places::of(mesh, surface)?;
        let (low, high) =
            uv.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), at| {
                (low.min(*at), high.max(*at))
            });
        Some(Self {
            positions: uv.iter().map(|at| (*at - low) * scale).collect(),
            own_places: particles.len(),
            is_closed: false,
            particles,
            of_mesh: (0..triangles.len() as u32).collect(),
            triangles,
            warp_cos2: 1.0,
            plane: None,
            extent: (high - low) * scale,
            warps: Vec::new(),
            area: surface.triangle_areas.iter().sum(),
            border: border_length(mesh, surface),
        })
    }
}

/// Lengths in the cloth over those in a texture, along u and v; none if the texture shows a back, or distorts the mesh.
pub(super) fn scale_of_texture(
    mesh: &RestMesh,
    surface: &Surface,
    corner_uv: &[[Vec2; 3]],
) -> Option<Vec2> {
    let area: f32 = surface.triangle_areas.iter().sum();
    let corners = mesh.triangles.iter().zip(corner_uv);
    let metrics: Vec<([f32; 3], f32)> = corners
        .map(|(&triangle, &uv)| metric(mesh.positions_of(triangle), uv))
        .collect::<Option<_>>()?;
    let mean = |of: usize| {
        let sum = metrics.iter().zip(&surface.triangle_areas).map(|((at, _), a)| at[of] * a);
        sum.sum::<f32>() / area
    };
    let scale = Vec2::new(mean(0), mean(2)).map(f32::sqrt);
    let is_like = |&([u_u, u_v, v_v], _): &([f32; 3], f32)| {
        let (p, q) = (u_u / (scale.x * scale.x), v_v / (scale.y * scale.y));
        let off = u_v / (scale.x * scale.y);
        // Eigenvalues of the metric.
        let (middle, radius) = (0.5 * (p + q), (0.25 * (p - q) * (p - q) + off * off).sqrt());
        middle + radius < DISTORTION && middle - radius > 1.0 / DISTORTION
    };
    let shows_back = metrics.iter().any(|(_, side)| *side != metrics[0].1);
    let unlike = metrics.iter().zip(&surface.triangle_areas).filter(|(it, _)| !is_like(it));
    let unlike: f32 = unlike.map(|(_, area)| area).sum();
    (!shows_back && unlike < MOST_UNLIKE * area).then_some(scale)
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::scale_of_texture;
    use crate::fabric::grid::Grid;
    use crate::fabric::mesh::{RestMesh, Surface};

    /// The scale of the texture of a sheet, given the place in it of each vertex.
    fn scale(of: impl Fn(Vec3) -> Vec2) -> Option<Vec2> {
        let grid = Grid::new(22, 22, 1.0, 1.0);
        let triangles = grid.triangles(false);
        let mesh = RestMesh {
            positions: grid.positions(),
            uv: Vec::new(),
            areas: Vec::new(),
            inverse_areas: Vec::new(),
            particle_of_vertex: Vec::new(),
            triangles: triangles.clone(),
        };
        let corner_uv: Vec<[Vec2; 3]> =
            triangles.iter().map(|corners| mesh.positions_of(*corners).map(&of)).collect();
        let areas = vec![1.0 / triangles.len() as f32; triangles.len()];
        let surface =
            Surface { triangle_areas: areas, corner_uv: corner_uv.clone(), edges: Vec::new() };
        scale_of_texture(&mesh, &surface, &corner_uv)
    }

    #[test]
    fn a_few_triangles_do_not_tell_of_a_whole_texture() {
        let like = |at: Vec3| at.truncate() * 2.0;
        let near = |at: Vec3, x: f32| (at - Vec3::new(x, -10.0 / 21.0, 0.0)).length() < 1e-3;
        let one_moved =
            |at: Vec3| like(at) + if near(at, 10.0 / 21.0) { Vec2::X * 0.05 } else { Vec2::ZERO };
        let found = scale(one_moved).expect("like the shape but for a vertex");
        assert!((found - 0.5).abs().max_element() < 0.02, "{found}");
        assert!(scale(|at| like(at) * Vec2::new(1.0 + at.x, 1.0)).is_none(), "twice as wide");
        assert!(scale(|at| like(at) * Vec2::new((at.x - 0.5).abs(), 1.0)).is_none(), "a back");
    }
}
