//! The mesh of a fabric: particles, triangles and edges, with their areas and pins.

use glam::{Vec2, Vec3};

use super::error::FabricError;
use super::normals::vertex_normals;
use super::topology::{self, Edge, Side};
use super::weld::Weld;

/// Least area of a triangle over the square of its longest edge. Smaller: the normals and stiffnesses of thin
/// triangles are rounding errors. Larger: sound meshes are refused.
const LEAST_ASPECT: f32 = 1e-6;

/// Particles and triangles at rest.
#[derive(Clone, Debug)]
pub(crate) struct RestMesh {
    /// Positions, m, one for each particle.
    pub positions: Vec<Vec3>,
    /// Texture coordinates, one per particle.
    pub uv: Vec<Vec2>,
    /// Particles at the corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// The particle that each vertex of the source mesh was merged into.
    pub particle_of_vertex: Vec<u32>,
    /// A third of the areas of a particle's triangles, m² (thesis, 5.1.3); on a grid a quarter of those of its cells.
    pub areas: Vec<f32>,
    /// One over the areas, 1/m²; zero if the particle is pinned (thesis, 5.1.4).
    pub inverse_areas: Vec<f32>,
}

/// Properties of a mesh that only the construction of its fabric needs.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// Areas of the triangles, m².
    pub triangle_areas: Vec<f32>,
    /// Texture coordinates at the corners of each triangle. Along a seam they differ from those of the particles, which
    /// are those of one side.
    pub corner_uv: Vec<[Vec2; 3]>,
    /// All edges, sorted by their ends.
    pub edges: Vec<Edge>,
}

impl RestMesh {
    /// Merges vertices into particles and measures their triangles.
    ///
    /// # Errors
    ///
    /// A triangle without area, a vertex without triangle, an edge of more than two triangles.
    pub(super) fn new(
        positions: &[Vec3],
        uv: &[Vec2],
        indices: &[u32],
        pinned: impl IntoIterator<Item = u32>,
        weld: Weld,
    ) -> Result<(Self, Surface), FabricError> {
        let Weld { particle_of_vertex, vertex_of_particle } = weld;
        let vertices = || vertex_of_particle.iter().map(|&vertex| vertex as usize);
        let particle = |vertex: u32| particle_of_vertex[vertex as usize];
        let corner_particles = |corners: &[u32]| [0, 1, 2].map(|corner| particle(corners[corner]));

        let rest: Vec<Vec3> = vertices().map(|vertex| positions[vertex]).collect();
        let triangles: Vec<[u32; 3]> = indices.chunks_exact(3).map(corner_particles).collect();
        let triangle_areas = triangle_areas(&rest, &triangles)?;
        let areas = particle_areas(rest.len(), &triangles, &triangle_areas);
        if let Some(loose) = areas.iter().position(|&area| area == 0.0) {
            return Err(FabricError::LooseVertex { vertex: vertex_of_particle[loose] as usize });
        }
        let edges = topology::edges(&triangles).map_err(|ends| {
            let [a, b] = ends.map(|end| vertex_of_particle[end as usize]);
            FabricError::NonManifoldEdge { a, b }
        })?;
        let mut inverse_areas: Vec<f32> = areas.iter().map(|area| 1.0 / area).collect();
        for vertex in pinned {
            inverse_areas[particle(vertex) as usize] = 0.0;
        }
        let uv_at = |vertex: usize| uv.get(vertex).copied().unwrap_or_default();
        let corner_uv =
            indices.chunks_exact(3).map(|at| [0, 1, 2].map(|corner| uv_at(at[corner] as usize)));
        let mesh = Self {
            positions: rest,
            uv: vertices().map(uv_at).collect(),
            triangles,
            areas,
            inverse_areas,
            particle_of_vertex,
        };
        let corner_uv = corner_uv.collect();
        Ok((mesh, Surface { triangle_areas, corner_uv, edges }))
    }

    /// Areas of the triangles, m².
    pub fn triangle_areas(&self) -> Vec<f32> {
        self.triangles.iter().map(|corners| any_area(self.positions_of(*corners))).collect()
    }

    /// Unit normals of the particles at given positions, m; zero if their triangles have no area.
    pub fn normals_at(&self, positions: &[Vec3]) -> Vec<Vec3> {
        let corners = |corners: &[u32; 3]| corners.map(|corner| positions[corner as usize]);
        let triangles = self.triangles.iter();
        vertex_normals(positions.len(), triangles.map(|triangle| (corners(triangle), *triangle)))
    }

    /// Takes over the area of each particle, m².
    pub fn set_areas(&mut self, areas: Vec<f32>) {
        for (inverse_area, area) in self.inverse_areas.iter_mut().zip(&areas) {
            if *inverse_area != 0.0 {
                *inverse_area = 1.0 / area;
            }
        }
        self.areas = areas;
    }

    /// The ends of an edge whose two triangles face opposite ways, if there is one, as on a Möbius strip.
    pub fn one_sided_edge(&self, edges: &[Edge]) -> Option<[u32; 2]> {
        let runs_along = |side: Side, [from, to]: [u32; 2]| {
            let corners = self.triangles[side.triangle as usize];
            (0..3).any(|at| [corners[at], corners[(at + 1) % 3]] == [from, to])
        };
        let faces_both = |edge: &&Edge| {
            let other = edge.other_side.is_some_and(|it| runs_along(it, edge.ends));
            edge.other_side.is_some() && runs_along(edge.side, edge.ends) == other
        };
        edges.iter().find(faces_both).map(|edge| edge.ends)
    }
    /// Whether a particle is pinned.
    pub fn is_pinned(&self, particle: u32) -> bool {
        self.inverse_areas[particle as usize] == 0.0
    }

    /// Positions of some particles, m.
    pub fn positions_of<const N: usize>(&self, particles: [u32; N]) -> [Vec3; N] {
        particles.map(|particle| self.positions[particle as usize])
    }
}

/// Areas of the triangles, m².
fn triangle_areas(rest: &[Vec3], triangles: &[[u32; 3]]) -> Result<Vec<f32>, FabricError> {
    let of_triangle = |(index, triangle): (usize, &[u32; 3])| {
        let corners = triangle.map(|corner| rest[corner as usize]);
        area(corners).ok_or(FabricError::ZeroArea { triangle: index })
    };
    triangles.iter().enumerate().map(of_triangle).collect()
}

/// Area of a triangle, m²; none if its corners lie on a line.
pub(super) fn area([a, b, c]: [Vec3; 3]) -> Option<f32> {
    let longest =
        (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let area = any_area([a, b, c]);
    (area > LEAST_ASPECT * longest).then_some(area)
}

/// The same of any triangle.
fn any_area([a, b, c]: [Vec3; 3]) -> f32 {
    0.5 * (b - a).cross(c - a).length()
}

/// Area of each particle, m²: a third of the area of each of its triangles.
fn particle_areas(count: usize, triangles: &[[u32; 3]], triangle_areas: &[f32]) -> Vec<f32> {
    let mut areas = vec![0.0; count];
    for (triangle, area) in triangles.iter().zip(triangle_areas) {
        for &corner in triangle {
            areas[corner as usize] += area / 3.0;
        }
    }
    areas
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::fabric::{FabricBuilder, Grid};

    #[test]
    fn mass_is_a_third_of_each_bordering_triangle() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 2.0, 0.0)];
        let builder = FabricBuilder::new(corners, vec![0, 1, 2, 1, 3, 2]);
        let (mesh, _) = builder.rest_mesh().expect("a good mesh");
        for (found, expected) in mesh.areas.iter().zip([0.5, 1.5, 1.5, 1.0]) {
            assert!((3.0 * found - expected).abs() < 1e-5, "{found}");
        }
    }

    #[test]
    fn mass_of_a_grid_is_a_quarter_of_each_bordering_cell() {
        let fabric = FabricBuilder::grid(Grid::new(5, 4, 2.0, 1.5)).build().expect("a good fabric");
        assert!((fabric.area() - 3.0).abs() < 1e-5);
        let quarters = [0, 1, 5, 6].map(|particle| 16.0 * fabric.particle_areas()[particle]);
        assert_eq!(quarters, [1.0, 2.0, 2.0, 4.0]);
    }
}
