//! Repair of meshes as artists ship them, when asked for.
//!
//! The steps: triangles without area are flipped away or removed (`degenerate`), and so are triangles that exist twice;
//! at each edge triangles are joined in pairs (`adjacency`); the winding is made consistent across joined edges
//! (`winding`); vertices whose triangles are not all joined are split (`fans`).

mod adjacency;
mod degenerate;
mod fans;
mod winding;

use std::collections::BTreeSet;

use glam::Vec3;

use super::source::FabricBuilder;
use crate::fabric::error::FabricError;
use crate::fabric::mesh::area;

/// What [`FabricBuilder::repair`] has done to a mesh. Vertices and triangles are numbered as in the given mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshRepair {
    /// Triangles without area that got a corner of their neighbour across their longest edge, as did the neighbour.
    pub flipped: Vec<usize>,
    /// Triangles without area that were removed.
    pub degenerate: Vec<usize>,
    /// Triangles that were removed since an earlier one has the same corners.
    pub duplicates: Vec<usize>,
    /// Triangles whose winding was turned over.
    pub turned: Vec<usize>,
    /// Edges of more than two triangles. The triangles that continue one another most straightly stay joined in pairs.
    pub split_edges: Vec<[u32; 2]>,
    /// Vertices whose triangles are joined only there, or at a split edge: each fan of triangles has its own vertex now.
    pub split_vertices: Vec<u32>,
    /// Vertices without triangles. They are no particles: show them where the mesh has them.
    pub loose: Vec<u32>,
    /// For each vertex of the repaired mesh, the vertex of the given mesh at the same position. Vertices of the given
    /// mesh come first, in their order, without those that are [`loose`](Self::loose); copies follow.
    pub vertices: Vec<u32>,
}

impl MeshRepair {
    /// Whether the mesh was sound, so that nothing was changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let Self { flipped, degenerate, duplicates, turned, .. } = self;
        let triangles = [flipped, degenerate, duplicates, turned];
        let Self { split_edges, split_vertices, loose, .. } = self;
        triangles.into_iter().all(Vec::is_empty)
            && split_edges.is_empty()
            && split_vertices.is_empty()
            && loose.is_empty()
    }
}

/// A mesh that is being repaired.
struct Repairing {
    /// Positions of the vertices, m.
    positions: Vec<Vec3>,
    /// The particle that each vertex is merged into.
    particle_of_vertex: Vec<u32>,
    triangles: Vec<Corners>,
    report: MeshRepair,
}

/// A triangle that is being repaired.
#[derive(Clone, Copy)]
struct Corners {
    /// Number in the given mesh.
    triangle: usize,
    vertices: [u32; 3],
}

impl Repairing {
    /// The particles at the corners of a triangle.
    fn particles(&self, corners: &Corners) -> [u32; 3] {
        corners.vertices.map(|vertex| self.particle_of_vertex[vertex as usize])
    }

    /// Whether a triangle has three particles and an area.
    fn has_area(&self, corners: &Corners) -> bool {
        let [a, b, c] = self.particles(corners);
        let at = corners.vertices.map(|vertex| self.positions[vertex as usize]);
        a != b && b != c && c != a && area(at).is_some()
    }

    /// Removes triangles with the same three particles as an earlier one.
    fn remove_duplicates(&mut self) {
        let mut known = BTreeSet::new();
        let (kept, removed) = core::mem::take(&mut self.triangles).into_iter().partition(|at| {
            let mut particles = self.particles(at);
            particles.sort_unstable();
            known.insert(particles)
        });
        self.triangles = kept;
        let removed: Vec<Corners> = removed;
        self.report.duplicates = removed.iter().map(|corners| corners.triangle).collect();
    }
}

impl FabricBuilder {
    /// Repairs the mesh: removes duplicate triangles and those without area, splits edges of more than two triangles
    /// and vertices whose triangles touch only there, makes the winding consistent (as that of the larger part of each
    /// connected piece), and leaves out vertices without triangles. Pins stay on all copies of a vertex. Returns what
    /// was done, too. Grids need no repair.
    ///
    /// # Errors
    ///
    /// [`FabricError::OneSided`] if a piece is one-sided, as a Möbius strip is, and has no consistent winding; the
    /// errors of lists that do not fit one another and of numbers that are not finite; [`FabricError::Empty`] if no
    /// triangle is left.
    pub fn repair(self) -> Result<(Self, MeshRepair), FabricError> {
        if !self.points.is_empty() {
            return Err(FabricError::PointsBeforeRepair);
        }
        self.validate()?;
        let mut report = MeshRepair::default();
        if self.grid.is_some() {
            report.vertices = (0..self.positions.len() as u32).collect();
            return Ok((self, report));
        }
        let triangles = self.indices.chunks_exact(3).enumerate();
        let corners =
            |(triangle, at): (usize, &[u32])| Corners { triangle, vertices: [at[0], at[1], at[2]] };
        let mut mesh = Repairing {
            triangles: triangles.map(corners).collect(),
            particle_of_vertex: self.weld().particle_of_vertex,
            positions: self.positions.clone(),
            report,
        };
        mesh.remove_degenerate();
        mesh.remove_duplicates();
        if mesh.triangles.is_empty() {
            return Err(FabricError::Empty);
        }
        let joints = mesh.join_triangles();
        mesh.make_winding_consistent(&joints)?;
        let fans = mesh.fans(&joints);
        Ok((self.with_vertices(&fans), mesh.report))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::fabric::mesh::RestMesh;
    use crate::fabric::topology::Edge;
    use crate::fabric::{Grid, Resolution};

    fn repaired(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> (FabricBuilder, MeshRepair) {
        let positions = positions.iter().copied().map(Vec3::from).collect();
        let builder = FabricBuilder::new(positions, triangles.as_flattened().to_vec());
        builder.repair().expect("a mesh that can be repaired")
    }

    /// The mesh with its vertices merged, and its edges.
    fn merged(builder: &FabricBuilder) -> (RestMesh, Vec<Edge>) {
        let (mesh, surface) = builder.rest_mesh().expect("a good mesh");
        (mesh, surface.edges)
    }

    /// Number of edges of two triangles.
    fn joined(edges: &[Edge]) -> usize {
        edges.iter().filter(|edge| edge.other_side.is_some()).count()
    }

    /// A square of two triangles, and places beside it.
    const AT: [[f32; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, 0.5, 1.0],
        [2.0, 2.0, 0.0],
        [1.0, 2.0, 0.0],
    ];
    const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [1, 3, 2]];

    #[test]
    fn a_sound_mesh_stays_as_it_is() {
        let (builder, report) = repaired(&AT[..4], &SQUARE);
        assert!(report.is_empty());
        assert_eq!(report.vertices, [0, 1, 2, 3]);
        assert_eq!(builder.indices, SQUARE.as_flattened());
    }

    #[test]
    fn duplicates_and_triangles_without_area_are_removed() {
        let (builder, report) =
            repaired(&AT[..4], &[SQUARE[0], SQUARE[1], [2, 1, 0], [0, 1, 1], [3, 2, 1]]);
        assert_eq!((&report.duplicates[..], &report.degenerate[..]), (&[2, 4][..], &[3][..]));
        assert_eq!(merged(&builder).0.triangles.len(), 2);
    }

    #[test]
    fn a_triangle_on_a_line_is_flipped_so_that_no_crack_opens() {
        // Vertex 1 lies on the edge from 0 to 4, with a triangle of no area between them.
        let (builder, report) = repaired(&AT[..5], &[[0, 1, 4], [0, 4, 3], [0, 3, 2]]);
        assert_eq!(report.flipped, [0]);
        assert!(report.degenerate.is_empty() && report.loose.is_empty());
        let (mesh, _) = merged(&builder);
        assert_eq!((mesh.triangles.len(), mesh.positions.len()), (3, 5));
        assert!((mesh.areas.iter().sum::<f32>() - 1.5).abs() < 1e-6);
    }

    #[test]
    fn the_winding_of_the_smaller_part_is_turned() {
        let strip = [[0, 1, 2], [1, 2, 3], [1, 4, 3]];
        let (builder, report) = repaired(&AT[..5], &strip);
        assert_eq!(report.turned, [1]);
        let normals = builder.rest_normals().expect("a mesh");
        assert!(normals.iter().all(|normal| normal.z > 0.9), "{normals:?}");
    }

    #[test]
    fn an_edge_of_three_triangles_keeps_the_two_that_are_flattest() {
        let fin = [SQUARE[0], SQUARE[1], [1, 2, 5]];
        let (builder, report) = repaired(&AT[..6], &[fin[2], fin[0], fin[1]]);
        assert_eq!(report.split_edges, [[1, 2]]);
        assert_eq!(report.split_vertices, [1, 2]);
        assert_eq!((builder.positions.len(), &report.loose[..]), (7, &[4][..]));
        let (mesh, edges) = merged(&builder);
        assert_eq!((mesh.positions.len(), joined(&edges)), (7, 1));
        let [_, one, other] = &mesh.triangles[..] else { panic!("three triangles") };
        let common = one.iter().filter(|corner| other.contains(corner)).count();
        assert_eq!(common, 2, "the square stays joined");
    }

    #[test]
    fn an_hourglass_is_split_at_its_waist_and_both_halves_stay_pinned() {
        let positions: Vec<Vec3> = AT.map(Vec3::from).to_vec();
        let indices = [[0, 1, 3], [3, 6, 7]].as_flattened().to_vec();
        let uv = positions.iter().map(|at| at.truncate()).collect();
        let builder = FabricBuilder::new(positions, indices).uv(uv).pin([3, 5]);
        let (builder, report) = builder.repair().expect("a mesh that can be repaired");
        assert_eq!(report.split_vertices, [3]);
        assert_eq!(report.loose, [2, 4, 5]);
        assert_eq!(report.vertices, [0, 1, 3, 6, 7, 3]);
        assert_eq!(builder.uv[5], Vec2::ONE);
        let (mesh, _) = merged(&builder);
        let pinned: Vec<u32> = (0..6).filter(|&particle| mesh.is_pinned(particle)).collect();
        assert_eq!((mesh.positions.len(), &pinned[..]), (6, &[2, 5][..]));
    }

    #[test]
    fn seams_stay_merged_where_an_edge_is_split() {
        // Two triangles with their own vertices along their common edge, and a fin on that edge.
        let positions = [AT[0], AT[1], AT[2], AT[1], AT[3], AT[2], AT[5]];
        let (builder, report) = repaired(&positions, &[[0, 1, 2], [3, 4, 5], [1, 2, 6]]);
        assert_eq!(report.split_edges.len(), 1);
        let (mesh, edges) = merged(&builder);
        assert_eq!((mesh.positions.len(), joined(&edges)), (7, 1));
        assert!(builder.rest_normals().is_ok_and(|normals| normals[0] == Vec3::Z));
    }

    #[test]
    fn sheets_that_cross_are_two_sheets_at_any_resolution() {
        let grid = Grid::new(9, 9, 1.0, 1.0);
        let flat = grid.positions();
        let across = flat.iter().map(|at| Vec3::new(0.5, at.y, at.x - 0.5));
        let triangles = grid.triangles(false);
        let count = flat.len() as u32;
        let second = triangles.iter().map(|corners| corners.map(|corner| corner + count));
        let indices: Vec<[u32; 3]> = triangles.iter().copied().chain(second).collect();
        let positions = flat.iter().copied().chain(across).collect();
        let builder = FabricBuilder::new(positions, indices.into_flattened());
        assert!(matches!(builder.clone().build(), Err(FabricError::NonManifoldEdge { .. })));
        let (builder, report) = builder.repair().expect("a mesh that can be repaired");
        assert_eq!(report.split_edges.len(), 8);
        assert_eq!(merged(&builder).0.positions.len(), 162);
        for size in [0.05, 0.1] {
            let fabric = builder.resampled(Resolution::CellSize(size)).expect("a mesh").fabric;
            assert!((fabric.area() - 2.0).abs() < 0.01, "{} m²", fabric.area());
        }
    }

    #[test]
    fn a_moebius_strip_is_an_error() {
        const PIECES: u32 = 12;
        let turn = core::f32::consts::TAU / PIECES as f32;
        let ends = (0..PIECES).flat_map(|piece| {
            let (sin, cos) = libm::sincosf(turn * piece as f32);
            let (tilt_sin, tilt_cos) = libm::sincosf(0.5 * turn * piece as f32);
            [-0.2, 0.2].map(|side: f32| {
                let radius = 1.0 + side * tilt_cos;
                Vec3::new(radius * cos, radius * sin, side * tilt_sin)
            })
        });
        let strip = |is_twisted: bool| {
            let positions = ends.clone().collect();
            let quads = (0..PIECES).flat_map(|piece| {
                let [a, b, mut c, mut d] = [0, 1, 2, 3].map(|at| (2 * piece + at) % (2 * PIECES));
                if piece + 1 == PIECES && is_twisted {
                    (c, d) = (d, c);
                }
                [a, c, b, b, c, d]
            });
            FabricBuilder::new(positions, quads.collect()).repair()
        };
        assert!(matches!(strip(true), Err(FabricError::OneSided { .. })));
        assert!(strip(false).is_ok_and(|(_, report)| report.is_empty()));
    }

    #[test]
    fn nothing_left_is_an_error() {
        let positions = AT.map(Vec3::from).to_vec();
        let line = FabricBuilder::new(positions, vec![0, 1, 4]).repair();
        assert_eq!(line.map(|_| ()), Err(FabricError::Empty));
    }
}
