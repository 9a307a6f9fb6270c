//! A detailed mesh bound to the smooth surface of a cloth.

use bevy_math::{Mat3, Vec3};
use bunting_solver::Subdivision;
use parry3d::query::PointQueryWithLocation;
use parry3d::shape::{TriMesh, TriMeshBuilderError};

/// The vertices of a mesh, each bound to the nearest point of a surface at rest: by barycentric coordinates, and an offset
/// in the frame of the surface there. Vertices that are nearer to the cloth's rigid part stay where they are.
#[derive(Clone, Debug)]
pub struct Binding {
    /// The vertices that move, by their indices.
    vertices: Vec<(usize, BoundVertex)>,
    /// Number of vertices of the mesh.
    count: usize,
    /// Greatest distance of a vertex from the surface, m.
    pub reach: f32,
}

#[derive(Clone, Copy, Debug)]
struct BoundVertex {
    corners: [u32; 3],
    weights: [f32; 3],
    /// Offset from the surface in its frame, m.
    offset: Vec3,
    /// Unit normal in the frame of the surface.
    normal: Vec3,
}

/// Positions (m) and unit normals of the surface's vertices.
#[derive(Clone, Debug, Default)]
pub struct SurfaceVertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
}

impl Binding {
    /// Binds a mesh, given by positions (m) and normals, to a surface at rest, and to the corners of rigid triangles, m.
    ///
    /// # Errors
    ///
    /// The surface has no triangles.
    pub fn new(
        surface: &SurfaceVertices,
        subdivision: &Subdivision,
        rigid: &[[Vec3; 3]],
        mesh: &SurfaceVertices,
    ) -> Result<Self, TriMeshBuilderError> {
        let moving = subdivision.triangles();
        let first = surface.positions.len() as u32;
        let rigid_triangles =
            (0..rigid.len() as u32).map(|it| [0, 1, 2].map(|at| first + 3 * it + at));
        let points = surface.positions.iter().map(|&at| Vec3::from(at));
        let nearest = TriMesh::new(
            points.chain(rigid.iter().flatten().copied()).collect(),
            moving.iter().copied().chain(rigid_triangles).collect(),
        )?;
        let mut reach = 0.0_f32;
        let bind = |(index, (&position, &normal)): (usize, (&[f32; 3], &[f32; 3]))| {
            let position = Vec3::from(position);
            let (_, (triangle, place)) =
                nearest.project_local_point_and_get_location(position, false);
            let mut bound = BoundVertex {
                corners: *moving.get(triangle as usize)?,
                weights: place.barycentric_coordinates().unwrap_or([1.0, 0.0, 0.0]),
                offset: Vec3::ZERO,
                normal: Vec3::ZERO,
            };
            let (foot, frame) = bound.frame(surface);
            reach = reach.max(position.distance(foot));
            bound.offset = frame.transpose() * (position - foot);
            bound.normal = frame.transpose() * Vec3::from(normal);
            Some((index, bound))
        };
        let all = mesh.positions.iter().zip(&mesh.normals).enumerate();
        let vertices = all.filter_map(bind).collect();
        Ok(Self { vertices, count: mesh.positions.len(), reach })
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.count
    }

    /// Writes positions (m) and normals of the vertices that the surface carries.
    pub fn carry(
        &self,
        surface: &SurfaceVertices,
        positions: &mut [[f32; 3]],
        mut normals: Option<&mut [[f32; 3]]>,
    ) {
        for &(index, ref vertex) in &self.vertices {
            let (foot, frame) = vertex.frame(surface);
            positions[index] = (foot + frame * vertex.offset).to_array();
            if let Some(normals) = &mut normals {
                normals[index] = (frame * vertex.normal).to_array();
            }
        }
    }
}

impl BoundVertex {
    /// The point of the surface, m, and the frame there: along the triangle's first edge, across, and the normal.
    fn frame(&self, surface: &SurfaceVertices) -> (Vec3, Mat3) {
        let [a, b, c] = self.corners.map(|corner| Vec3::from(surface.positions[corner as usize]));
        let normals = self.corners.map(|corner| Vec3::from(surface.normals[corner as usize]));
        let sum = |values: [Vec3; 3]| {
            values.into_iter().zip(self.weights).map(|(value, weight)| value * weight).sum::<Vec3>()
        };
        let normal = sum(normals).normalize_or_zero();
        let along = (b - a).reject_from_normalized(normal).normalize_or_zero();
        (sum([a, b, c]), Mat3::from_cols(along, normal.cross(along), normal))
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::Quat;
    use bunting_solver::{FabricBuilder, Grid, SubdivisionBuffers};

    use super::*;

    /// Rounding of positions of some metres, m.
    const ROUNDING: f32 = 5e-6;

    #[test]
    fn a_rigid_motion_carries_the_mesh_rigidly() {
        let grid = Grid::new(9, 7, 2.0, 1.0);
        let fabric = FabricBuilder::grid(grid).build().expect("a grid");
        let subdivision = Subdivision::of_grid(&grid, 1);
        let bent: Vec<Vec3> =
            fabric.rest_positions().iter().map(|at| at.with_z(0.3 * at.x * at.x)).collect();
        let surface = |positions: &[Vec3]| {
            let count = subdivision.attributes().rows().len();
            let mut surface = SurfaceVertices {
                positions: vec![[0.0; 3]; count],
                normals: vec![[0.0; 3]; count],
            };
            let SurfaceVertices { positions: drawn, normals } = &mut surface;
            subdivision.evaluate(positions, &mut SubdivisionBuffers::default(), drawn, normals);
            surface
        };
        // A ring around the cloth: in front, behind, and beyond its border.
        let around = (0..40).map(|at| {
            let angle = 0.157 * at as f32;
            Vec3::new(1.0 + 1.2 * angle.cos(), -0.5 + 0.4 * angle.sin(), 0.1 * (7.0 * angle).sin())
        });
        let positions: Vec<Vec3> = around.collect();
        let normals: Vec<Vec3> = positions.iter().map(|at| (*at + Vec3::Y).normalize()).collect();
        let arrays = |values: &[Vec3]| values.iter().map(Vec3::to_array).collect::<Vec<_>>();
        let mesh = SurfaceVertices { positions: arrays(&positions), normals: arrays(&normals) };
        let binding = Binding::new(&surface(&bent), &subdivision, &[], &mesh).expect("triangles");
        assert!((0.1..1.1).contains(&binding.reach), "{}", binding.reach);
        let turn = Quat::from_euler(bevy_math::EulerRot::XYZ, 1.0, 2.0, 3.0);
        let shift = Vec3::new(1.0, -2.0, 0.5);
        let moved: Vec<Vec3> = bent.iter().map(|&at| turn * at + shift).collect();
        let mut carried = mesh.clone();
        binding.carry(&surface(&moved), &mut carried.positions, Some(&mut carried.normals));
        for (at, was) in carried.positions.iter().zip(&positions) {
            assert!((Vec3::from(*at) - (turn * *was + shift)).length() < ROUNDING, "{was}");
        }
        for (at, was) in carried.normals.iter().zip(&normals) {
            assert!((Vec3::from(*at) - turn * *was).length() < ROUNDING, "{was}");
        }
    }
}
