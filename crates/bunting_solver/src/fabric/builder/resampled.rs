//! Surfaces that are simulated with particles of their own, and carry the meshes that they were made from.

use std::sync::Arc;

use super::on_surface::OnSurface;
use super::rectangle::Rectangle;
use super::source::FabricBuilder;
use crate::fabric::carried::Carried;
use crate::fabric::error::FabricError;
use crate::fabric::fabric::Fabric;
use crate::fabric::interpolation::{Interpolation, Term};
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::net::Net;
use crate::fabric::regions::{Ground, MaterialRegion};
use crate::fabric::remesh::{Nodes, OnNodes, PointOn, Refined, Source};

/// Greatest length of an edge of the mesh on which a lattice is found, in cells. Longer: where lines of the lattice end, holes as
/// large as a triangle are left.
const LONGEST_EDGE: f32 = 2.5;

/// Greatest number of particles. More: a size of cells that was meant in other units makes the memory overflow.
const MOST_PARTICLES: u32 = 1_000_000;

/// Number of particles by default: a square then has some thirty cells along its sides, as many as folds need to look like cloth.
const PARTICLES: u32 = 1000;

/// How finely a mesh is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Resolution {
    /// About a thousand particles.
    #[default]
    Auto,
    /// Size of the cells between particles, m.
    CellSize(f32),
    /// About as many particles.
    Particles(u32),
}

/// A fabric whose particles lie on lines along warp and weft, whatever the triangles of the mesh that it was made from, and how
/// that mesh follows it. Made by [`FabricBuilder::resampled`]. [`Fabric::particle_of_vertex`] tells the particle at each vertex,
/// or the nearest one; of a pinned vertex the nearest pinned one.
#[derive(Clone, Debug)]
pub struct Resampled {
    /// What is simulated.
    pub fabric: Arc<Fabric>,
    /// How the mesh follows.
    pub carried: Carried,
    /// The vertices of the mesh around each particle with their weights, whose sum is 1: those of the triangle that it lies on, by
    /// which what is known of vertices is interpolated.
    pub corners: Vec<Vec<(u32, f32)>>,
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
        self.laid(resolution).map(|Laid { fabric, carried, corners, cell_size }| Resampled {
            fabric: Arc::new(fabric),
            carried,
            corners,
            cell_size,
        })
    }

    /// The same before the fabric is shared.
    pub(super) fn laid(&self, resolution: Resolution) -> Result<Laid, FabricError> {
        let (mesh, surface) = self.rest_mesh()?;
        let vertex_of_place = self.weld().vertex_of_particle;
        check_sides(&mesh, &surface, &vertex_of_place)?;
        let points = self.points_on_triangles()?;
        let source = Source::new(&mesh, &surface, &[]);
        let size = match resolution {
            Resolution::Auto => source.cell_size(f64::from(PARTICLES)),
            Resolution::CellSize(size) => f64::from(size),
            Resolution::Particles(count) => source.cell_size(f64::from(count)),
        };
        let count = source.node_count(size);
        if !(size > 0.0 && count > 0.0 && count <= f64::from(MOST_PARTICLES)) {
            let (size, particles) = (size as f32, count as f32);
            return Err(FabricError::CellSize { size, particles, most: MOST_PARTICLES });
        }
        let at = |place: u32| FabricError::Cells {
            vertex: vertex_of_place[place as usize],
            size: size as f32,
        };
        let rectangle = || Rectangle::of(&mesh, &source, size as f32);
        let on_grid = match points.is_empty().then(rectangle).flatten() {
            Some(rectangle) => {
                rectangle.laid(&mesh, self.regions_of(&vertex_of_place), self.tethered)?
            }
            None => None,
        };
        let OnSurface { mut fabric, on_nodes, particles, corners } = match on_grid {
            Some(on_grid) => on_grid,
            None => {
                let regions = self.regions_of(&vertex_of_place);
                let surface = (&mesh, &surface);
                on_lattice(surface, (source, &points), size, &regions, self.tethered).map_err(at)?
            }
        };
        let OnNodes { rows, heights, held } = on_nodes;
        let RestMesh { particle_of_vertex: place_of_vertex, triangles, .. } = mesh;
        fabric.set_vertices(&place_of_vertex, &particles);
        let corners = corners.iter().map(|row| {
            let inside = || row.iter().filter(|term| term.weight > 0.0);
            let sum: f32 = inside().map(|term| term.weight).sum();
            let of_vertex = |it: &Term| (vertex_of_place[it.from as usize], it.weight / sum);
            inside().map(of_vertex).collect()
        });
        Ok(Laid {
            fabric,
            corners: corners.collect(),
            carried: Carried { rows, heights, held, place_of_vertex, triangles },
            cell_size: size as f32,
        })
    }
}

/// A net on a surface, in cells of a size, m.
///
/// # Errors
///
/// A place where there can't be cells.
fn on_lattice(
    (mesh, surface): (&RestMesh, &Surface),
    (given, points): (Source, &[PointOn]),
    size: f64,
    regions: &[MaterialRegion],
    tethered: bool,
) -> Result<OnSurface, u32> {
    let refined = Refined::of(mesh, surface, LONGEST_EDGE * size as f32, points);
    let original = |place: u32| {
        let of_refined = refined.as_ref().map(|it| Term::heaviest(&it.origins[place as usize]));
        of_refined.flatten().map_or(place, |it| it.from)
    };
    let of_refined = refined.as_ref().map(|it| Source::new(&it.mesh, &it.surface, &it.points));
    let source = of_refined.unwrap_or(given);
    let nodes = Nodes::on_lattice(&source, size).map_err(original)?;
    let corners = nodes.corners.iter().map(|row| match &refined {
        Some(refined) => {
            let origins = |it: &Term| (&refined.origins[it.from as usize][..], it.weight);
            Term::sum(row.iter().map(origins))
        }
        None => row.clone(),
    });
    let corners: Vec<Vec<Term>> = corners.collect();
    let vary = |mesh: &RestMesh, cells: Vec<Vec<u32>>| {
        let (edges, corners) = (&nodes.edges, corners.clone());
        Ground { mesh, edges, is_flat: false, cells, corners }.variation(regions)
    };
    let (net, cells) = Net::of(&nodes, vary).ok_or(0_u32)?;
    let cells = cells.iter().map(|cell| &cell[..]);
    let count = mesh.positions.len();
    let on_nodes = nodes.carried(&source, cells, count).map_err(original)?;
    let pins: Vec<u32> = nodes.pins_of_vertices(&source, count).collect();
    let particles = particles_of_places(mesh, &nodes, &pins, &on_nodes.rows);
    let mut fabric = Fabric::of_nodes(net, tethered);
    fabric.particle_of_point = nodes.of_points(&source);
    Ok(OnSurface { fabric, on_nodes, particles, corners })
}

/// Checks that the triangles of a mesh agree on its front, given the vertex at each place.
///
/// # Errors
///
/// [`FabricError::OneSided`].
pub(super) fn check_sides(
    mesh: &RestMesh,
    surface: &Surface,
    vertex_of_place: &[u32],
) -> Result<(), FabricError> {
    match mesh.one_sided_edge(&surface.edges) {
        Some(ends) => {
            let [a, b] = ends.map(|place| vertex_of_place[place as usize]);
            Err(FabricError::OneSided { a, b })
        }
        None => Ok(()),
    }
}

/// [`Resampled`] with a fabric that nothing shares yet.
pub(super) struct Laid {
    pub fabric: Fabric,
    carried: Carried,
    corners: Vec<Vec<(u32, f32)>>,
    cell_size: f32,
}

/// The node at each place, or that with the greatest weight there; of a pinned place the nearest one of the pins of vertices.
fn particles_of_places(
    mesh: &RestMesh,
    nodes: &Nodes,
    pins: &[u32],
    rows: &Interpolation,
) -> Vec<u32> {
    let nearest_pin = |place: u32| {
        let at = mesh.positions[place as usize];
        let away = |pin: &u32| nodes.mesh.positions[*pin as usize].distance_squared(at);
        pins.iter().copied().min_by(|one, other| away(one).total_cmp(&away(other)))
    };
    let places = (0..).zip(&nodes.node_of).zip(rows.rows());
    let of_place = |((place, node), row): ((u32, &Option<u32>), &[Term])| {
        let of_pin = || if mesh.is_pinned(place) { nearest_pin(place) } else { None };
        node.or_else(of_pin).or_else(|| Some(Term::heaviest(row)?.from)).unwrap_or(0)
    };
    places.map(of_place).collect()
}
