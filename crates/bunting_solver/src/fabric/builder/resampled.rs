//! Surfaces that are simulated with particles of their own, and carry the meshes that they were made from.

use std::sync::Arc;

use glam::Vec3;

use super::source::FabricBuilder;
use crate::fabric::background::{Interpolation, Term};
use crate::fabric::carried::Carried;
use crate::fabric::error::FabricError;
use crate::fabric::fabric::Fabric;
use crate::fabric::mesh::RestMesh;
use crate::fabric::quads::Net;
use crate::fabric::remesh::{Nodes, Refined, Source};

/// Greatest length of an edge of the mesh on which a lattice is found, in cells. Longer: where lines of the lattice end, holes as
/// large as a triangle are left.
const LONGEST_EDGE: f32 = 2.5;

/// Greatest number of particles. More: a size of cells that was meant in other units makes the memory overflow.
const MOST_PARTICLES: u32 = 1_000_000;

/// How finely a mesh is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Size of the cells between particles, m.
    CellSize(f32),
    /// About as many particles.
    Particles(u32),
}

/// A fabric whose particles lie on lines along warp and weft, whatever the triangles of the mesh that it was made from, and how
/// that mesh follows it. Made by [`FabricBuilder::resampled`].
#[derive(Clone, Debug)]
pub struct Resampled {
    /// What is simulated.
    pub fabric: Arc<Fabric>,
    /// How the mesh follows.
    pub carried: Carried,
    /// The particle at each vertex of the mesh, or the nearest one; of a pinned vertex the nearest pinned one.
    pub particles: Vec<u32>,
    /// The vertex of the mesh that is nearest to each particle.
    pub nearest_vertices: Vec<u32>,
    /// Size of the cells between particles, m.
    pub cell_size: f32,
}

impl FabricBuilder {
    /// Builds a fabric with particles of its own: on lines along warp and weft, on borders and at pins, at about the same
    /// distance everywhere. Stretch, shear and bending are solved exactly along these lines, which those of a mesh's triangles are
    /// not. The mesh [follows](Resampled::carried).
    ///
    /// ```
    /// use bunting_solver::{FabricBuilder, Grid, Resolution};
    ///
    /// // A mesh of 84 triangles is far too coarse to drape.
    /// let grid = FabricBuilder::grid(Grid::new(8, 7, 0.7, 0.6));
    /// let coarse = FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec());
    /// let cape = coarse.pin_where(|at, _| at.y == 0.0).resampled(Resolution::CellSize(0.03))?;
    /// assert!(cape.fabric.particle_count() > 400);
    /// let positions = cape.carried.positions(cape.fabric.rest_positions());
    /// assert_eq!(positions.len(), 56);
    /// # Ok::<(), bunting_solver::FabricError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build); [`FabricError::OneSided`] of a mesh without front; [`FabricError::CellSize`], and
    /// [`FabricError::Cells`] where the surface can't be divided into cells.
    pub fn resampled(&self, resolution: Resolution) -> Result<Resampled, FabricError> {
        self.validate()?;
        let welded = self.weld();
        let vertex_of_place = welded.vertex_of_particle.clone();
        let pinned = self.pinned.iter().copied();
        let (mesh, surface) =
            RestMesh::new(&self.positions, &self.uv, &self.indices, pinned, welded)?;
        let given = Source::new(&mesh, &surface);
        if let Some(ends) = given.one_sided_edge() {
            let [a, b] = ends.map(|place| vertex_of_place[place as usize]);
            return Err(FabricError::OneSided { a, b });
        }
        let size = match resolution {
            Resolution::CellSize(size) => f64::from(size),
            Resolution::Particles(count) => given.cell_size(f64::from(count)),
        };
        let count = given.node_count(size);
        if !(size > 0.0 && count > 0.0 && count <= f64::from(MOST_PARTICLES)) {
            let (size, particles) = (size as f32, count as f32);
            return Err(FabricError::CellSize { size, particles, most: MOST_PARTICLES });
        }
        let refined = Refined::of(&mesh, &surface, LONGEST_EDGE * size as f32);
        let original = |place: u32| {
            let of_refined = refined.as_ref().map(|it| it.origins[place as usize]);
            vertex_of_place[of_refined.unwrap_or(place) as usize]
        };
        let at = |place: u32| FabricError::Cells { vertex: original(place), size: size as f32 };
        let of_refined = refined.as_ref().map(|it| Source::new(&it.mesh, &it.surface));
        let source = of_refined.unwrap_or(given);
        let nodes = Nodes::on_lattice(&source, size).map_err(at)?;
        let (net, cells) = Net::of_nodes(&nodes).ok_or_else(|| at(0))?;
        let cells = cells.iter().map(|cell| &cell[..]);
        let (rows, heights) = nodes.carried(&source, cells, mesh.positions.len()).map_err(at)?;
        let particles = particles_of_places(&mesh, &nodes, &rows);
        let nearest = nodes.nearest_vertices.iter();
        let nearest_vertices = nearest.map(|&place| original(place)).collect();
        let RestMesh { particle_of_vertex: place_of_vertex, triangles, .. } = mesh;
        Ok(Resampled {
            fabric: Arc::new(Fabric::of_nodes(net, self.tethered)),
            particles: place_of_vertex.iter().map(|&place| particles[place as usize]).collect(),
            nearest_vertices,
            carried: Carried { rows, heights, place_of_vertex, triangles },
            cell_size: size as f32,
        })
    }
}

/// The node at each place, or that with the greatest weight there; the nearest pinned one of a pinned place.
fn particles_of_places(mesh: &RestMesh, nodes: &Nodes, rows: &Interpolation) -> Vec<u32> {
    let pins: Vec<(u32, Vec3)> = (0..)
        .zip(&nodes.mesh.positions)
        .filter(|(node, _)| nodes.mesh.is_pinned(*node))
        .map(|(node, at)| (node, *at))
        .collect();
    let nearest_pin = |place: u32| {
        let at = mesh.positions[place as usize];
        let away = |pin: &(u32, Vec3)| pin.1.distance_squared(at);
        pins.iter().min_by(|one, other| away(one).total_cmp(&away(other))).map(|(node, _)| *node)
    };
    let places = (0..).zip(&nodes.node_of).zip(rows.rows());
    let of_place = |((place, node), row): ((u32, &Option<u32>), &[Term])| {
        let of_pin = || if mesh.is_pinned(place) { nearest_pin(place) } else { None };
        node.or_else(of_pin).or_else(|| Some(Term::heaviest(row)?.from)).unwrap_or(0)
    };
    places.map(of_place).collect()
}
