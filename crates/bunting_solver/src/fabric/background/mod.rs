//! The background grid of a triangle mesh that is flat at rest, or has a texture that is like it, or can be unfolded, or maps onto a
//! rectangle, as tapered sheets and funnels do.
//!
//! Links along the edges of an irregular mesh are no paths along which a load runs: chains of them are short and
//! zigzag, and what they leave to relaxation converges slowly. So such a mesh gets a regular grid, as particles have
//! in the material point method. Stretch, shear and bending are solved on the grid, exactly along its lines
//! (`constraints/background.rs`). The positions of the nodes are found from those of the
//! particles, and the particles follow the nodes.
//!
//! `chart` lays a flat mesh into the plane, `texture` a curved one, `unfold` one without texture, and `closed` finds
//! the period of one that is closed around an axis. `laid_nodes` lays a grid onto the chart: `coverage` measures how much of
//! each cell is cloth, `interpolation` and `cells` find the weights, `smooth` those of nodes on curved meshes, and `cut` those beyond the
//! border. `hold` finds out whether nodes hold the mesh where its pins do; if not, `moved` moves some to the pins. `mapped` finds
//! charts whose lines are curved, and unevenly far apart, as those of a mesh are that unfolds with distortion: there each link and
//! each cell has its own width and, by `warps`, its own direction. Cells also have directions of their own where the texture has
//! `pieces`. `whole` refuses grids that would sew up slits. `gradient_fit` finds the functions with wanted gradients that
//! `unfold` and `mapped` need.

mod cells;
mod chart;
mod closed;
mod coverage;
mod cut;
mod gradient_fit;
mod hold;
mod interpolation;
mod laid_nodes;
mod laplacian;
mod mapped;
mod moved;
mod on_chart;
mod pieces;
mod smooth;
#[cfg(test)]
mod tests;
mod texture;
mod unfold;
mod warps;
mod whole;

use core::cell::OnceCell;

use glam::{Mat3, Vec2, Vec3};

use self::cells::{InCell, particles_from_nodes};
use self::chart::Chart;
use self::laid_nodes::LaidNodes;
use self::on_chart::OnChart;
use super::cell_sizes::CellSizes;
use super::grid::Grid;
use super::mesh::{RestMesh, Surface};

pub(super) use self::chart::lies_in_plane;
pub(crate) use self::interpolation::{Interpolation, RowGroup, Term};
pub(super) use self::smooth::{GREATEST_SUM, RADIUS, fit_smooth};

/// Fewest particles of a mesh with a background grid, or with lines of quads. Smaller meshes have no paths that are long.
pub(super) const FEWEST_PARTICLES: usize = 30;

/// Least mass of a node, as a part of the particles' mean mass. Smaller: nodes around which no particle lies weigh
/// nothing.
const LEAST_MASS: f32 = 0.2;

/// Part of a node's weights that must be of free particles; else the node is pinned.
const LEAST_FREE: f32 = 0.5;

/// The same where nodes are moved to pins: others are pinned only among pins.
const LEAST_FREE_BESIDE_MOVED: f32 = 0.01;

/// Weights with which a grid reads a mesh's particles and moves them.
#[derive(Clone, Debug)]
pub(crate) struct GridTransfer {
    /// Of each node the particles that its position is interpolated from.
    pub nodes: Interpolation,
    /// Of each free particle the nodes that its position is interpolated from.
    pub particles: Interpolation,
    /// Of each free node the mean of the particles that its displacement moves.
    pub means: Interpolation,
    /// Of each pinned node the particles that its position is interpolated from.
    pub held: Interpolation,
    /// Area of the free particles that the displacement of each node moves, m².
    pub moved_areas: Vec<f32>,
    /// How far each free particle of a mesh that is curved at rest, or whose nodes are moved, lies above the surface between
    /// nodes; else empty. Without them each substep would flatten the mesh, as a particle between nodes lies below the arc through
    /// them.
    pub heights: Vec<Height>,
    /// Pairs of nodes at one place, where a mesh is closed around an axis.
    pub joined: Vec<[u32; 2]>,
}

/// The distance of a particle from the surface between nodes at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Height {
    /// The particle.
    pub particle: u32,
    /// Four nodes around the particle, two opposite ones first. The vectors between opposite ones are tangents.
    pub nodes: [u32; 4],
    /// Coordinates along the two tangents, in units of these.
    pub along: [f32; 2],
    /// Coordinate along the unit vector product of the tangents, m.
    pub height: f32,
}

impl Height {
    /// How far a particle lies away (m) from the surface between nodes, given four of these and their positions; none if two opposite
    /// ones lie at one place.
    pub(super) fn of(
        particle: u32,
        nodes: [u32; 4],
        [a, b, c, d]: [Vec3; 4],
        away: Vec3,
    ) -> Option<Self> {
        let frame = Mat3::from_cols(b - a, d - c, (b - a).cross(d - c).normalize_or_zero());
        let Vec3 { x, y, z } = frame.inverse() * away;
        let is_finite = x.is_finite() && y.is_finite() && z.is_finite();
        is_finite.then_some(Self { particle, nodes, along: [x, y], height: z })
    }
}

/// A background grid before its constraints are found.
pub(super) struct BackgroundMesh {
    pub grid: Grid,
    /// The nodes as particles.
    pub mesh: RestMesh,
    /// How much cloth each cell stands for, in units of its area.
    pub coverage: Vec<f32>,
    /// Whether only a part of some cells is cloth.
    pub is_cut: bool,
    /// The sizes of cells that are not alike.
    pub sizes: Option<CellSizes>,
    /// cos² of the angle between the rows and the warp.
    pub warp_cos2: f32,
    /// cos² of the angle between the rows and the warp in each cell, where lines of nodes are curved, or the texture has pieces.
    pub warps: Option<Vec<f32>>,
    /// Whether the nodes lie in a plane at rest, and are evenly spaced.
    pub is_flat: bool,
    /// Whether all cells are alike at rest, so that their diagonals are.
    pub are_alike: bool,
    pub transfer: GridTransfer,
}

impl BackgroundMesh {
    /// The grid of a mesh: on a chart with straight lines that it fills, on one of a rectangle that it maps onto, or on one that it
    /// does not fill. None of a mesh that is small, that overlaps itself on each chart, or whose grid would sew up a slit: laid yarns
    /// hold such meshes (`fabric/laid_yarns/`).
    pub fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        if mesh.positions.len() < FEWEST_PARTICLES {
            return None;
        }
        let of_largest = pieces::of_largest_piece(mesh, surface);
        let laid = of_largest.as_ref().unwrap_or(surface);
        let of_pieces = of_largest.as_ref().map(|_| surface);
        let on_chart = |chart: Chart| OnChart::of(mesh, laid, of_pieces, chart);
        let on_mapped = || {
            let on = Chart::mapped(mesh, laid).and_then(on_chart);
            on.filter(|on| on.coverage.is_filled)?.background()
        };
        let mapped = OnceCell::new();
        let is_not_mapped = || mapped.get_or_init(on_mapped).is_none();
        let straight = Chart::of(mesh, laid, is_not_mapped).and_then(on_chart);
        let fills = |on: &&OnChart| on.coverage.is_filled && on.chart.warps.is_empty();
        let found = straight.as_ref().filter(fills).and_then(OnChart::background);
        found
            .or_else(|| mapped.into_inner().unwrap_or_else(on_mapped))
            .or_else(|| straight.as_ref().filter(|on| !fills(on))?.background())
            .or_else(|| on_chart(Chart::without_seams(mesh, laid)?)?.background())
    }

    /// The grid of a mesh on a chart, given its nodes; none if its cells are too unlike one another.
    fn on(on: &OnChart, mut laid: LaidNodes) -> Option<Self> {
        let OnChart { mesh, chart, grid, is_free, .. } = on;
        let (grid, mut has_row) = (*grid, is_free.clone());
        has_row[chart.own_places..].fill(false);
        let mut particles = particles_from_nodes(&chart.positions, &has_row, &grid, &laid);
        if laid.has_cloth.contains(&false) {
            // A tip may lie in a cell in which it is too small to count as cloth.
            particles = particles.with_terms_of(&laid.has_cloth);
        }
        let particles = particles.mean_rows(&chart.particles, mesh.positions.len());
        let joined = if chart.is_closed { grid.ends_of_columns().collect() } else { Vec::new() };
        let nodes = core::mem::take(&mut laid.rows).with_columns(&chart.particles);
        let mut transfer = GridTransfer {
            // Nodes beyond the border are fitted to every n-th place nearby, and these are others at the other end.
            nodes: nodes.with_pairs_alike(&joined),
            particles,
            means: Interpolation::default(),
            held: Interpolation::default(),
            moved_areas: Vec::new(),
            heights: Vec::new(),
            joined,
        };
        transfer.moved_areas = transfer.node_masses(&mesh.free_areas());
        let positions = rest_positions(mesh, chart, &laid.places, &transfer);
        let has_curved_lines = !chart.warps.is_empty();
        let sizes = (has_curved_lines || laid.are_cut || laid.are_moved).then(|| {
            // The part of a cell in a grid that is filled is one but for rounding.
            let whole = vec![1.0; laid.parts.len()];
            let parts = if laid.are_cut { &laid.parts } else { &whole };
            CellSizes::of(&grid, &positions, chart.is_closed, parts)
        });
        let mut nodes = node_mesh(mesh, &grid, &transfer, positions, sizes.as_ref(), &laid);
        // Paths along the cloth run through cells that have some.
        let cells = nodes.triangles.chunks(2).zip(&laid.cells_with_cloth);
        let with_cloth = cells.filter(|(_, has_cloth)| **has_cloth);
        nodes.triangles = with_cloth.flat_map(|(cell, _)| cell).copied().collect();
        if has_curved_lines && !mapped::is_regular(&grid, &nodes, &laid.cells_with_cloth) {
            return None;
        }
        let is_free = |node: usize| !nodes.is_pinned(node as u32);
        transfer.means = transfer.particles.adjoint(&mesh.areas, &transfer.moved_areas, is_free);
        let stands_for_pins = |node: usize| !is_free(node) && nodes.areas[node] > 0.0;
        transfer.held = transfer.nodes.rows_where(stands_for_pins);
        let is_flat = chart.plane.is_some() && !laid.are_moved;
        if !is_flat {
            transfer.heights = heights(mesh, chart, &grid, &nodes, &transfer, &laid);
        }
        let GridTransfer { nodes: first, particles, means, held, .. } = &mut transfer;
        for rows in [first, particles, means, held] {
            *rows = core::mem::take(rows).grouped();
        }
        let warps = match on.of_pieces {
            Some(surface) => Some(pieces::warps_of_cells(on, surface, &laid.triangles)),
            None => has_curved_lines.then(|| warps_of_cells(&transfer.nodes, &chart.warps, &grid)),
        };
        Some(Self {
            // Those of cells hold where there are some.
            warp_cos2: if warps.is_some() { 1.0 } else { chart.warp_cos2 },
            warps,
            mesh: nodes,
            is_cut: laid.are_cut,
            coverage: laid.parts,
            sizes,
            are_alike: !has_curved_lines && !laid.are_moved && chart.plane.is_some(),
            is_flat,
            transfer,
            grid,
        })
    }
}

impl GridTransfer {
    /// The mass of each node, given those of the particles, zero where they are pinned.
    pub fn node_masses(&self, of_particles: &[f32]) -> Vec<f32> {
        let mut moved = self.particles.transposed_product(of_particles, self.nodes.len());
        // Both nodes of a pair have half of the stiffness.
        for pair in &self.joined {
            let [first, second] = pair.map(|node| moved[node as usize]);
            pair.iter().for_each(|&node| moved[node as usize] = 0.5 * (first + second));
        }
        let least = LEAST_MASS * of_particles.iter().sum::<f32>() / of_particles.len() as f32;
        moved.into_iter().map(|mass| mass.max(least)).collect()
    }
}

/// The heights of the free particles.
fn heights(
    mesh: &RestMesh,
    chart: &Chart,
    grid: &Grid,
    nodes: &RestMesh,
    transfer: &GridTransfer,
    laid: &LaidNodes,
) -> Vec<Height> {
    let mut is_done = vec![false; mesh.positions.len()];
    let rows: Vec<&[Term]> = transfer.particles.rows().collect();
    let mut heights = Vec::new();
    for (&at, &particle) in chart.positions.iter().zip(&chart.particles).take(chart.own_places) {
        // A particle on a seam has the height of one side.
        if mesh.is_pinned(particle) || is_done[particle as usize] {
            continue;
        }
        is_done[particle as usize] = true;
        // A node without cloth stays where it is.
        let cell = InCell::of(at, grid, laid).corners_with_cloth(grid, laid);
        let Some([first, right, below_first, last]) = cell else { continue };
        let corners = [first, last, right, below_first];
        let row = rows[particle as usize];
        let below: Vec3 =
            row.iter().map(|term| nodes.positions[term.from as usize] * term.weight).sum();
        let away = mesh.positions[particle as usize] - below;
        heights.extend(Height::of(particle, corners, nodes.positions_of(corners), away));
    }
    heights
}

/// cos² of the angle between the rows and the warp in each cell, given those at the particles.
fn warps_of_cells(nodes: &Interpolation, of_particles: &[f32], grid: &Grid) -> Vec<f32> {
    let of_node = |row: &[Term]| -> f32 {
        row.iter().map(|term| term.weight * of_particles[term.from as usize]).sum()
    };
    let of_nodes: Vec<f32> = nodes.rows().map(of_node).collect();
    let mean = |corners: [u32; 4]| corners.map(|at| 0.25 * of_nodes[at as usize]).iter().sum();
    grid.cells().map(|(corners, _)| f32::clamp(mean(corners), 0.0, 1.0)).collect()
}

/// Positions of the nodes at rest, m.
fn rest_positions(
    mesh: &RestMesh,
    chart: &Chart,
    places: &[Vec2],
    transfer: &GridTransfer,
) -> Vec<Vec3> {
    let in_space = |(at, row): (&Vec2, &[Term])| match &chart.plane {
        Some(plane) => plane.in_space(*at),
        None => row.iter().map(|term| mesh.positions[term.from as usize] * term.weight).sum(),
    };
    places.iter().zip(transfer.nodes.rows()).map(in_space).collect()
}

/// The nodes as particles. Nodes that stand for pinned particles are pinned, but not outside the mesh; nodes without cloth have no
/// area and do not move. The others have the areas of a grid's particles: with those of the particles that they move,
/// which differ from node to node by chance, a swing loses motion to short waves.
fn node_mesh(
    mesh: &RestMesh,
    grid: &Grid,
    transfer: &GridTransfer,
    positions: Vec<Vec3>,
    sizes: Option<&CellSizes>,
    laid: &LaidNodes,
) -> RestMesh {
    let least_free = if laid.are_moved { LEAST_FREE_BESIDE_MOVED } else { LEAST_FREE };
    let is_free = |row: &[Term]| {
        let free = row.iter().filter(|term| !mesh.is_pinned(term.from));
        free.map(|term| term.weight).sum::<f32>() > least_free
    };
    let areas = match sizes {
        Some(sizes) => sizes.particle_areas(grid),
        None => grid.particle_areas(),
    };
    let inverse_area = |(node, (row, area)): (usize, (&[Term], &f32))| {
        let moves = laid.is_outside[node] || !laid.is_near_pins[node] || is_free(row);
        if *area > 0.0 && moves { 1.0 / area } else { 0.0 }
    };
    RestMesh {
        positions,
        inverse_areas: transfer.nodes.rows().zip(&areas).enumerate().map(inverse_area).collect(),
        uv: chart::node_positions(grid),
        triangles: grid.triangles(false),
        particle_of_vertex: (0..areas.len() as u32).collect(),
        areas,
    }
}
