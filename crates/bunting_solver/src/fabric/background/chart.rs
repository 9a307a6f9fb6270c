//! A mesh laid into the plane: a flat one along its warp or along the sides of its bounding rectangle, a curved one by
//! its texture, or unfolded.

use core::ops::Range;

use glam::{Vec2, Vec3};

use super::texture::scale_of_texture;
use super::unfold::Unfolded;
use super::warps::warps_of_rows;
use crate::fabric::grid::Grid;
use crate::fabric::links::warp_direction;
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::topology;

/// Greatest distance of a particle from the mean plane, as a part of the mesh's extent. Larger: curved meshes are
/// flattened.
const FLAT: f32 = 1e-4;

/// Part of its narrowest bounding rectangle above which a mesh counts as a rectangle, along whose sides it is laid.
/// Larger: rectangles with rounded corners have rows that end at slanting borders.
const FILLED: f32 = 0.97;

/// Area of a roughly unfolded mesh, in units of its bounding rectangle's, that may turn out to fill the rectangle without overlapping
/// itself. With a larger lower bound, cylinders of few cells with ragged seams are refused that close when they are unfolded
/// accurately; with a smaller upper bound, meshes that only seem to overlap themselves.
const MAY_FILL: Range<f32> = 0.8..1.05;

/// How much more of its narrowest rectangle than of that along the warp a mesh must fill to be laid along the former.
/// Smaller: rounding turns a mesh.
const TIGHTER: f32 = 1e-4;

/// cos of the angle to the warp or the weft up to which a row runs along it: 3°.
const ALONG: f32 = 0.9986;

/// Mean of cos² of the angle between the warp and its mean direction below which a mesh is of pieces with different
/// warps. Larger: textures that are distorted a little count as pieces.
const ONE_WARP: f32 = 0.9;

/// Spacing of vertices, in units of the grid's, above which they count as coarse. Smaller: on meshes that are even but random some
/// nodes are fitted to more vertices than others. Larger: some have too few vertices to be fitted to.
const COARSE: f32 = 1.5;

/// A mesh in the plane.
pub(super) struct Chart {
    /// Places in the plane, m, from the corner of their bounding rectangle.
    pub positions: Vec<Vec2>,
    /// The particle at each place. A particle on a seam of the texture has two.
    pub particles: Vec<u32>,
    /// How many of the places, the first ones, are not repeated beyond the seam of a closed chart.
    pub own_places: usize,
    /// Whether the chart is one period along its second axis.
    pub is_closed: bool,
    /// Three places for each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the mesh that each of them is.
    pub of_mesh: Vec<u32>,
    /// cos² of the angle between the first axis and the warp.
    pub warp_cos2: f32,
    /// The plane of a flat mesh.
    pub plane: Option<Plane>,
    pub extent: Vec2,
    /// cos² of the angle between the rows and the warp at each particle, where the lines of the grid are curved; empty
    /// where they are straight.
    pub warps: Vec<f32>,
    /// Of the mesh, m².
    pub area: f32,
    /// Length of its border, m.
    pub border: f32,
}

/// The plane of a flat mesh.
pub(super) struct Plane {
    /// Corner of the bounding rectangle, m.
    origin: Vec3,
    axes: [Vec3; 2],
}

impl Chart {
    /// The chart of a mesh; none if it is folded or of pieces with different warps, or if it has no texture that is
    /// like it and cannot be unfolded. If it is unfolded and then does not fill its rectangle, it may turn out that it is not needed.
    pub fn of(
        mesh: &RestMesh,
        surface: &Surface,
        is_needed_unfilled: impl FnOnce() -> bool,
    ) -> Option<Self> {
        let Some(normal) = plane_normal(mesh) else {
            let flat = |unfolded| Some(Self::of_unfolded(mesh, surface, unfolded)?.closed());
            let goes_on = |rough: Unfolded| {
                flat(rough).is_none_or(|chart| chart.may_fill()) || is_needed_unfilled()
            };
            let by_texture = Self::by_texture(mesh, surface).map(Self::closed);
            return by_texture.or_else(|| flat(Unfolded::of(mesh, surface, goes_on)?));
        };
        let warps = Warps::of(mesh, surface);
        let warp = warps.mean().unwrap_or_else(|| normal.any_orthonormal_vector());
        warps.are_along(warp).then(|| Self::in_plane(mesh, surface, normal, warp))
    }

    /// The chart of a curved mesh that is unfolded without seams; none of a flat mesh, and of one without a border.
    pub fn without_seams(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let has_border = surface.edges.iter().any(|edge| edge.other_side.is_none());
        if !has_border || plane_normal(mesh).is_some() {
            return None;
        }
        Self::of_unfolded(mesh, surface, Unfolded::without_seams(mesh, surface)?)
    }

    /// Where unfolding distorts the mesh, the lines of the chart are curved.
    fn of_unfolded(mesh: &RestMesh, surface: &Surface, unfolded: Unfolded) -> Option<Self> {
        let Unfolded { places, particles, triangles } = unfolded;
        let uv = |corners: &[u32; 3]| corners.map(|place| places[place as usize].as_vec2());
        let corner_uv: Vec<[Vec2; 3]> = triangles.iter().map(uv).collect();
        let is_distorted = scale_of_texture(mesh, surface, &corner_uv).is_none();
        let edges = topology::edges(&triangles).ok()?;
        if edges.iter().all(|edge| edge.other_side.is_some()) {
            return None;
        }
        let flat = RestMesh {
            positions: places.iter().map(|at| at.as_vec2().extend(0.0)).collect(),
            uv: Vec::new(),
            particle_of_vertex: Vec::new(),
            areas: Vec::new(),
            inverse_areas: Vec::new(),
            triangles,
        };
        let unfolded = Surface { edges, corner_uv, ..surface.clone() };
        let chart = Self::in_plane(&flat, &unfolded, Vec3::Z, Vec3::X);
        let warps = if is_distorted {
            warps_of_rows(mesh, surface, &chart.positions, &chart.triangles)?
        } else {
            Vec::new()
        };
        Some(Self { particles, plane: None, warps, border: border_length(mesh, surface), ..chart })
    }

    /// The chart of a flat mesh along its warp, or along the sides of its bounding rectangle if it fills that better.
    fn in_plane(mesh: &RestMesh, surface: &Surface, normal: Vec3, warp: Vec3) -> Self {
        let area: f32 = surface.triangle_areas.iter().sum();
        let mut best = Self::along(mesh, area, normal, warp);
        let filled = |chart: &Self| area / chart.extent.element_product();
        let rectangle = narrowest(mesh, surface, area, normal);
        if filled(&rectangle) > FILLED.max(filled(&best) + TIGHTER) {
            best = rectangle;
        }
        let along = best.plane.as_ref().map_or(warp, |plane| plane.axes[0]);
        let warp_cos2 = along.dot(warp).powi(2).min(1.0);
        best.border = border_length(mesh, surface);
        // Rounding does not turn a warp.
        best.warp_cos2 = if warp_cos2 > ALONG * ALONG { 1.0 } else { warp_cos2 };
        best
    }

    /// The chart with its first axis along a direction in the plane. Its second axis points down the rows of a grid.
    fn along(mesh: &RestMesh, area: f32, normal: Vec3, direction: Vec3) -> Self {
        let right = (direction - normal * normal.dot(direction)).normalize();
        let axes = [right, right.cross(normal)];
        let flat = |at: Vec3| Vec2::new(at.dot(axes[0]), at.dot(axes[1]));
        let (low, high) = mesh
            .positions
            .iter()
            .map(|&at| flat(at))
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), at| {
                (low.min(at), high.max(at))
            });
        let height = normal * normal.dot(mesh.positions[0]);
        Self {
            positions: mesh.positions.iter().map(|&at| flat(at) - low).collect(),
            particles: (0..mesh.positions.len() as u32).collect(),
            own_places: mesh.positions.len(),
            is_closed: false,
            triangles: mesh.triangles.clone(),
            of_mesh: (0..mesh.triangles.len() as u32).collect(),
            warp_cos2: 1.0,
            plane: Some(Plane { origin: height + axes[0] * low.x + axes[1] * low.y, axes }),
            extent: high - low,
            warps: Vec::new(),
            area,
            border: 0.0,
        }
    }

    /// The grid over the bounding rectangle with about as many nodes as there are particles.
    pub fn grid(&self) -> Grid {
        let Vec2 { x: width, y: height } = self.extent;
        let spacing = self.spacing();
        // Of a lattice the spacing is that of its nodes, of which there is one more than cells. A closed one has its first row twice.
        let last = u32::from(self.is_lattice());
        let nodes = |extent: f32| ((extent / spacing).round() as u32 + last).max(2);
        Grid::new(nodes(width), nodes(height), width, height)
    }

    /// Whether a chart that differs a little may fill its rectangle, and not overlap itself.
    fn may_fill(&self) -> bool {
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            0.5 * (b - a).perp_dot(c - a).abs()
        };
        let covered: f32 = self.triangles.iter().map(area).sum();
        self.is_closed || MAY_FILL.contains(&(covered / self.extent.element_product()))
    }

    /// Whether some particles have two places.
    pub fn has_seam(&self) -> bool {
        let mut particles = self.particles[..self.own_places].to_vec();
        particles.sort_unstable();
        particles.windows(2).any(|two| two[0] == two[1])
    }

    /// Spacing of the vertices around each place, in units of the grid's: the side of a square of twice the mean area of the triangles
    /// there. One where it is less than [`COARSE`].
    pub(super) fn coarseness(&self, spacing: f32) -> Vec<f32> {
        let mut sums = vec![(0.0, 0.0_f32); self.positions.len()];
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            let double_area = (b - a).perp_dot(c - a).abs();
            for &corner in corners {
                let (area, count) = &mut sums[corner as usize];
                *area += double_area;
                *count += 1.0;
            }
        }
        let of_place = |&(area, count): &(f32, f32)| (area / count.max(1.0)).sqrt() / spacing;
        let coarse = |width: f32| if width > COARSE { width } else { 1.0 };
        sums.iter().map(of_place).map(coarse).collect()
    }

    /// Spacing h of the grid, m. In a square lattice with a border of length L, an area A has N = A/h² + L/2h + 1 vertices, by Pick's
    /// theorem, and one fewer where it is closed around an axis: a mesh in rows and columns has its nodes on its vertices.
    pub(super) fn spacing(&self) -> f32 {
        let vertices = self.own_places as f32;
        if !self.is_lattice() {
            return (self.area / vertices).sqrt();
        }
        let vertices = vertices - if self.is_closed { 0.0 } else { 1.0 };
        let quarter = 0.25 * self.border;
        (quarter + (quarter * quarter + vertices * self.area).sqrt()) / vertices
    }

    /// Whether nodes may lie on the vertices of a mesh in rows and columns. In others a node at a ragged border would take over the air
    /// that a vertex there feels, which is that at the middle of a single triangle.
    fn is_lattice(&self) -> bool {
        self.is_closed || self.area > FILLED * self.extent.element_product()
    }
}

impl Plane {
    /// The place in space of a place in the plane, m.
    pub fn in_space(&self, at: Vec2) -> Vec3 {
        self.origin + self.axes[0] * at.x + self.axes[1] * at.y
    }
}

/// Positions of a grid's nodes in the plane, m.
pub(super) fn node_positions(grid: &Grid) -> Vec<Vec2> {
    grid.positions().iter().map(|at| Vec2::new(at.x, -at.y)).collect()
}

/// The unit normal of the plane that a mesh lies in; none if it lies in none, or a triangle shows its back.
fn plane_normal(mesh: &RestMesh) -> Option<Vec3> {
    let is_front =
        |normal: &Vec3| mesh.triangles.iter().all(|of| twice_area(mesh, of).dot(*normal) > 0.0);
    mean_normal(mesh).filter(|normal| is_flat(mesh, *normal)).filter(is_front)
}

/// Whether a mesh lies in a plane.
pub(in crate::fabric) fn lies_in_plane(mesh: &RestMesh) -> bool {
    mean_normal(mesh).is_some_and(|normal| is_flat(mesh, normal))
}

fn mean_normal(mesh: &RestMesh) -> Option<Vec3> {
    mesh.triangles.iter().map(|of| twice_area(mesh, of)).sum::<Vec3>().try_normalize()
}

/// The normal of a triangle, as long as twice its area, m².
fn twice_area(mesh: &RestMesh, triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = mesh.positions_of(*triangle);
    (b - a).cross(c - a)
}

fn is_flat(mesh: &RestMesh, normal: Vec3) -> bool {
    let first = mesh.positions[0];
    let extent = mesh.positions.iter().map(|at| at.distance(first)).fold(0.0, f32::max);
    mesh.positions.iter().all(|&at| (at - first).dot(normal).abs() < FLAT * extent)
}

/// Length of a mesh's border, m.
pub(super) fn border_length(mesh: &RestMesh, surface: &Surface) -> f32 {
    let border = surface.edges.iter().filter(|edge| edge.other_side.is_none());
    border.map(|edge| mesh.positions_of(edge.ends)).map(|[a, b]| a.distance(b)).sum()
}

/// The warps of a mesh's triangles that have texture, times their areas.
struct Warps(Vec<Vec3>);

impl Warps {
    fn of(mesh: &RestMesh, surface: &Surface) -> Self {
        let has_texture = |[a, b, c]: &[Vec2; 3]| (*b - *a).perp_dot(*c - *a) != 0.0;
        let triangles = mesh.triangles.iter().zip(&surface.corner_uv).zip(&surface.triangle_areas);
        let directions =
            triangles.filter(|((_, uv), _)| has_texture(uv)).map(|((&triangle, &uv), &area)| {
                warp_direction(mesh.positions_of(triangle), uv) * area
            });
        Self(directions.collect())
    }

    /// The mean direction, where u may run either way; none if the texture does not say.
    fn mean(&self) -> Option<Vec3> {
        let first = *self.0.first()?;
        let one_way = |warp: &Vec3| if warp.dot(first) < 0.0 { -*warp } else { *warp };
        self.0.iter().map(one_way).sum::<Vec3>().try_normalize()
    }

    /// Whether nearly all of the cloth has its warp along a direction.
    fn are_along(&self, direction: Vec3) -> bool {
        let areas = self.0.iter().map(|warp| warp.length());
        let along = self.0.iter().zip(areas.clone()).filter(|(_, area)| *area > 0.0);
        let along: f32 = along.map(|(warp, area)| warp.dot(direction).powi(2) / area).sum();
        along >= ONE_WARP * areas.sum::<f32>()
    }
}

/// The chart along that edge of the border whose bounding rectangle is the smallest.
fn narrowest(mesh: &RestMesh, surface: &Surface, area: f32, normal: Vec3) -> Chart {
    let border = surface.edges.iter().filter(|edge| edge.other_side.is_none());
    let mut directions: Vec<Vec3> = border
        .map(|edge| {
            let [a, b] = mesh.positions_of(edge.ends);
            (b - a).normalize()
        })
        .collect();
    // Edges of one side, and of opposite sides, are tried once.
    let mut tried: Vec<Vec3> = Vec::new();
    directions.retain(|direction| {
        let is_new = !tried.iter().any(|other| other.dot(*direction).abs() > ALONG);
        if is_new {
            tried.push(*direction);
        }
        is_new
    });
    let charts =
        directions.into_iter().map(|direction| Chart::along(mesh, area, normal, direction));
    let rectangle = |chart: &Chart| chart.extent.element_product();
    charts.min_by(|a, b| rectangle(a).total_cmp(&rectangle(b))).expect("a flat mesh has a border")
}
