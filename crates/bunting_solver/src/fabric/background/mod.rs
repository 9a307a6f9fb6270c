//! The background grid of a triangle mesh that is flat at rest, whose texture is like it, or that can be unfolded.
//!
//! Links along the edges of an irregular mesh are no paths along which a load runs: chains of them are short and
//! zigzag, and what they leave to relaxation converges slowly. So such a mesh gets a regular grid, as particles have
//! in the material point method. Stretch, shear and bending are solved on the grid, exactly along its lines
//! (`constraints/background.rs`). The positions of the nodes are found from those of the
//! particles, and the particles follow the nodes.
//!
//! `chart` lays a flat mesh into the plane, `texture` a curved one, `unfold` one without texture, and `closed` finds the
//! period of one that is closed around an axis. `coverage` measures how much of each cell is cloth, `interpolation` finds
//! the weights, and `smooth` those of nodes on curved meshes.

mod chart;
mod closed;
mod coverage;
mod interpolation;
mod smooth;
mod texture;
mod unfold;

use glam::{Mat3, Vec2, Vec3};

use self::chart::Chart;
use self::interpolation::{nodes_from_particles, particles_from_nodes};
use super::grid::Grid;
use super::mesh::{RestMesh, Surface};

pub(crate) use self::interpolation::{Interpolation, RowGroup, Term};

/// Fewest particles of a mesh with a background grid. Smaller meshes have no paths that are long.
const FEWEST_PARTICLES: usize = 30;

/// Least part of its bounding rectangle that a mesh must fill for its grid to bend as a whole. Smaller: lines of nodes
/// lead through holes.
const WHOLE: f32 = 0.995;

/// Greatest distance of a pinned particle from a pinned node, in cells. Larger: a cloth hangs by less than its pins.
const HELD_WITHIN: f32 = 0.8;

/// Least mass of a node, as a part of the particles' mean mass. Smaller: fits at the border, whose weights may be
/// negative, make nodes that weigh nothing.
const LEAST_MASS: f32 = 0.2;

/// Part of a node's weights that must be of free particles; else the node is pinned.
const LEAST_FREE: f32 = 0.5;

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
    /// How far each free particle of a mesh that is curved at rest lies above the surface between nodes; empty for flat
    /// meshes. Without them each substep would flatten the mesh, as a particle between nodes lies below the arc through
    /// them.
    pub heights: Vec<Height>,
    /// Pairs of nodes at one place, where a mesh is closed around an axis.
    pub joined: Vec<[u32; 2]>,
    /// Whether the mesh fills the whole grid.
    pub is_whole: bool,
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

/// A background grid before its constraints are found.
pub(super) struct BackgroundMesh {
    pub grid: Grid,
    /// The nodes as particles. Those outside the mesh are pinned.
    pub mesh: RestMesh,
    /// How much cloth each cell stands for, in units of its area.
    pub coverage: Vec<f32>,
    /// cos² of the angle between the rows and the warp.
    pub warp_cos2: f32,
    pub transfer: GridTransfer,
}

impl BackgroundMesh {
    /// The grid of a mesh; none of a mesh that is small or narrow, or cannot be laid into the plane without distortion
    /// or overlap.
    pub fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        if mesh.positions.len() < FEWEST_PARTICLES {
            return None;
        }
        let chart = Chart::of(mesh, surface)?;
        let grid = chart.grid();
        let nodes = nodes_from_particles(&chart.positions, &chart.triangles, &grid);
        let is_free: Vec<bool> = chart.particles.iter().map(|&at| !mesh.is_pinned(at)).collect();
        let mut has_row = is_free.clone();
        has_row[chart.own_places..].fill(false);
        let places = particles_from_nodes(&chart.positions, &has_row, &nodes, &grid)?;
        let particles = places.mean_rows(&chart.particles, mesh.positions.len());
        let nodes = match chart.plane {
            Some(_) => nodes,
            None => smooth::smoothed(nodes, &chart.positions, &grid, &is_free),
        };
        let nodes = nodes.with_columns(&chart.particles);
        let covered = coverage::covered_once(&chart.positions, &chart.triangles, &grid)?;
        let in_mesh = |node: u32| nodes.has_row(node as usize);
        let coverage = coverage::given_to_whole_cells(&covered, &grid, in_mesh);
        // Lines of nodes bend from straight ones.
        let is_whole = chart.plane.is_some()
            && (0..nodes.len() as u32).all(in_mesh)
            && covered.iter().sum::<f32>() > WHOLE * covered.len() as f32;
        let mut transfer = GridTransfer {
            nodes,
            particles,
            means: Interpolation::default(),
            held: Interpolation::default(),
            moved_areas: Vec::new(),
            heights: Vec::new(),
            joined: if chart.is_closed { first_and_last_row(&grid) } else { Vec::new() },
            is_whole,
        };
        let free_areas = mesh.areas.iter().zip(&mesh.inverse_areas);
        let free_areas: Vec<f32> =
            free_areas.map(|(&area, &inverse)| if inverse > 0.0 { area } else { 0.0 }).collect();
        transfer.moved_areas = transfer.node_masses(&free_areas);
        let nodes = node_mesh(mesh, &chart, &grid, &transfer);
        let is_free = |node: usize| !nodes.is_pinned(node as u32);
        transfer.means = transfer.particles.adjoint(&mesh.areas, &transfer.moved_areas, is_free);
        transfer.held = transfer.nodes.rows_where(|node| !is_free(node));
        if chart.plane.is_none() {
            transfer.heights = heights(mesh, &chart, &grid, &nodes, &transfer);
        }
        let is_held = is_held(mesh, &chart, &grid, &nodes, &transfer.nodes);
        let GridTransfer { nodes: first, particles, means, held, .. } = &mut transfer;
        for rows in [first, particles, means, held] {
            *rows = core::mem::take(rows).grouped();
        }
        is_held.then_some(Self {
            mesh: nodes,
            coverage,
            warp_cos2: chart.warp_cos2,
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

/// The heights of the free particles whose cells have all of their nodes.
fn heights(
    mesh: &RestMesh,
    chart: &Chart,
    grid: &Grid,
    nodes: &RestMesh,
    transfer: &GridTransfer,
) -> Vec<Height> {
    let spacing = Vec2::from(grid.spacing());
    let last = Vec2::new((grid.columns - 2) as f32, (grid.rows - 2) as f32);
    let mut is_done = vec![false; mesh.positions.len()];
    let rows: Vec<&[Term]> = transfer.particles.rows().collect();
    let mut heights = Vec::new();
    for (&at, &particle) in chart.positions.iter().zip(&chart.particles).take(chart.own_places) {
        let cell = (at / spacing).floor().clamp(Vec2::ZERO, last);
        let corner =
            |right: u32, down: u32| grid.index(cell.x as u32 + right, cell.y as u32 + down);
        let corners = [corner(0, 0), corner(1, 1), corner(1, 0), corner(0, 1)];
        let has_nodes = corners.iter().all(|&node| transfer.nodes.has_row(node as usize));
        // A particle on a seam has the height of one side.
        if mesh.is_pinned(particle) || is_done[particle as usize] || !has_nodes {
            continue;
        }
        is_done[particle as usize] = true;
        let row = rows[particle as usize];
        let below: Vec3 =
            row.iter().map(|term| nodes.positions[term.from as usize] * term.weight).sum();
        let [a, b, c, d] = nodes.positions_of(corners);
        let frame = Mat3::from_cols(b - a, d - c, (b - a).cross(d - c).normalize_or_zero());
        let away = mesh.positions[particle as usize] - below;
        let Vec3 { x, y, z } = frame.inverse() * away;
        if x.is_finite() && y.is_finite() && z.is_finite() {
            heights.push(Height { particle, nodes: corners, along: [x, y], height: z });
        }
    }
    heights
}

/// The nodes of the first and of the last row of a grid, in pairs.
fn first_and_last_row(grid: &Grid) -> Vec<[u32; 2]> {
    (0..grid.columns).map(|column| [0, grid.rows - 1].map(|row| grid.index(column, row))).collect()
}

/// Whether the grid is held where the mesh is: near each pinned particle a node is pinned.
fn is_held(
    mesh: &RestMesh,
    chart: &Chart,
    grid: &Grid,
    nodes: &RestMesh,
    in_mesh: &Interpolation,
) -> bool {
    let spacing = Vec2::from(grid.spacing());
    let last = Vec2::new((grid.columns - 1) as f32, (grid.rows - 1) as f32);
    let is_near_pinned_node = |at: Vec2| {
        let cell = (at / spacing).floor().min(last - 1.0).max(Vec2::ZERO);
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|corner| cell + corner);
        corners.into_iter().any(|node| {
            let index = grid.index(node.x as u32, node.y as u32);
            let is_near = node.distance(at / spacing) < HELD_WITHIN;
            is_near && nodes.is_pinned(index) && in_mesh.has_row(index as usize)
        })
    };
    let places = chart.particles.iter().zip(&chart.positions).take(chart.own_places);
    let mut pinned = places.filter(|(particle, _)| mesh.is_pinned(**particle));
    pinned.all(|(_, &at)| is_near_pinned_node(at))
}

/// The nodes as particles. Those that stand for pinned particles, or for none, are pinned. Where the mesh fills the grid,
/// nodes have the areas of a grid's particles: with those of the particles that they move, which differ from node to node
/// by chance, a swing loses motion to short waves.
fn node_mesh(mesh: &RestMesh, chart: &Chart, grid: &Grid, transfer: &GridTransfer) -> RestMesh {
    let areas =
        if transfer.is_whole { grid.particle_areas() } else { transfer.moved_areas.clone() };
    let is_free = |row: &[Term]| {
        let free = row.iter().filter(|term| !mesh.is_pinned(term.from));
        free.map(|term| term.weight).sum::<f32>() > LEAST_FREE
    };
    let rows = transfer.nodes.rows().zip(&areas);
    let in_chart = chart::node_positions(grid);
    let in_space = |(&at, row): (&Vec2, &[Term])| match &chart.plane {
        Some(plane) => plane.in_space(at),
        None => row.iter().map(|term| mesh.positions[term.from as usize] * term.weight).sum(),
    };
    let positions = in_chart.iter().zip(transfer.nodes.rows()).map(in_space).collect();
    RestMesh {
        positions,
        inverse_areas: rows
            .map(|(row, area)| if is_free(row) { 1.0 / area } else { 0.0 })
            .collect(),
        uv: in_chart,
        triangles: grid.triangles(false),
        particle_of_vertex: (0..areas.len() as u32).collect(),
        areas,
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use crate::fabric::{FabricBuilder, Grid, Interpolation};

    /// A disk of half a metre: rings of six, twelve, eighteen … vertices about its centre.
    fn disk(rings: u32) -> FabricBuilder {
        let mut positions = vec![Vec3::ZERO];
        let mut indices = Vec::new();
        let first = |ring: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
        for ring in 1..=rings {
            let count = 6 * ring;
            for place in 0..count {
                let angle = core::f32::consts::TAU * place as f32 / count as f32;
                let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
                positions.push(Vec3::new(cos, sin, 0.0) * (0.5 * ring as f32 / rings as f32));
            }
            let inner =
                |place: u32| first(ring - 1) + if ring > 1 { place % (count - 6) } else { 0 };
            let outer = |place: u32| first(ring) + place % count;
            for sector in 0..6 {
                for at in 0..ring {
                    let (out, within) = (sector * ring + at, sector * (ring - 1) + at);
                    indices.extend([outer(out), outer(out + 1), inner(within)]);
                    if at + 1 < ring {
                        indices.extend([inner(within), outer(out + 1), inner(within + 1)]);
                    }
                }
            }
        }
        FabricBuilder::new(positions, indices)
    }

    /// Greatest difference of a plane's values from what a row interpolates from them.
    fn error(rows: &Interpolation, from: &[Vec3], to: &[Vec3]) -> f32 {
        let plane = |at: &Vec3| 0.3 + at.dot(Vec3::new(1.0, -2.0, 0.0));
        let of_row = |(row, to): (&[super::Term], &Vec3)| {
            let sum: f32 =
                row.iter().map(|term| plane(&from[term.from as usize]) * term.weight).sum();
            if row.is_empty() { 0.0 } else { (sum - plane(to)).abs() }
        };
        rows.rows().zip(to).map(of_row).fold(0.0, f32::max)
    }

    #[test]
    fn weights_reproduce_planes_and_keep_the_mass() {
        let fabric = disk(12).build().expect("a good fabric");
        let background = fabric.background().expect("a flat mesh has a grid");
        let [particles, nodes] = [&fabric, &*background.fabric].map(|of| of.rest_positions());
        let transfer = &background.transfer;
        assert!(!transfer.is_whole, "nodes lie outside a disk");
        assert!(error(&transfer.nodes, particles, nodes) < 1e-5);
        assert!(error(&transfer.particles, nodes, particles) < 1e-5);
        let masses = transfer.node_masses(fabric.particle_areas());
        let in_mesh = masses.iter().zip(transfer.nodes.rows()).filter(|(_, row)| !row.is_empty());
        let mass: f32 = in_mesh.map(|(mass, _)| mass).sum();
        assert!((mass / fabric.area() - 1.0).abs() < 0.02, "{mass}");
    }

    #[test]
    fn cells_stand_for_all_of_the_cloth() {
        for rings in [8, 12, 20] {
            let fabric = disk(rings).build().expect("a good fabric");
            let mesh = fabric.background().expect("a flat mesh has a grid");
            // Warp links store ½ k l² = ½ Y A at a strain of one, A being the area that they stand for.
            let warp = mesh.fabric.links().iter().filter(|link| link.family as u32 == 0);
            let area: f32 = warp
                .map(|link| {
                    let [one, ..] = mesh.fabric.link_classes()[link.class as usize].coefficients;
                    one * link.rest_length * link.rest_length
                })
                .sum();
            // Negative coefficients, which make room for diagonals, are left out of none: the sum is the area.
            assert!((area / fabric.area() - 1.0).abs() < 0.05, "{rings}: {area}");
        }
    }

    /// A square metre of `n` × `n` vertices, rolled up about a vertical axis until its sides meet, without texture.
    fn cylinder(n: u32) -> FabricBuilder {
        let sheet = Grid::new(n, n, 1.0, 1.0);
        let radius = 1.0 / core::f32::consts::TAU;
        let roll = |at: &Vec3| {
            let (sin, cos) = libm::sincosf(at.x / radius);
            Vec3::new(radius * sin, at.y, radius * cos)
        };
        let positions = sheet.positions().iter().map(roll).collect();
        let triangles = sheet.triangles(false).into_flattened();
        FabricBuilder::new(positions, triangles).weld_distance(1e-4)
    }

    #[test]
    fn a_closed_mesh_has_a_grid_around_its_axis() {
        let fabric = cylinder(25).build().expect("a good fabric");
        let background = fabric.background().expect("it can be unfolded");
        let transfer = &background.transfer;
        let nodes = background.fabric.rest_positions();
        assert_eq!(transfer.joined.len(), 25);
        for joined in &transfer.joined {
            let [first, second] = joined.map(|node| nodes[node as usize]);
            assert!(first.distance(second) < 1e-5, "{first} {second}");
            let [first, second] = joined.map(|node| transfer.moved_areas[node as usize]);
            assert_eq!(first, second);
        }
        let mass: f32 = transfer.moved_areas.iter().sum();
        assert!((mass / fabric.area() - 1.0).abs() < 1e-3, "{mass}");
    }

    #[test]
    fn meshes_that_are_no_charts_keep_their_own_chains() {
        let has_grid =
            |builder: FabricBuilder| builder.build().expect("a good fabric").background().is_some();
        assert!(has_grid(disk(8)));
        let indices = disk(8).indices().to_vec();
        let from_above: Vec<Vec2> = disk(8).positions().iter().map(|at| at.truncate()).collect();
        let raised_by = |height: fn(Vec3) -> f32| {
            let up = |at: &Vec3| *at + Vec3::Z * height(*at);
            FabricBuilder::new(disk(8).positions().iter().map(up).collect(), indices.clone())
        };
        let arch = raised_by(|at| 2.0 * at.x * at.x);
        assert!(has_grid(arch.clone()), "not flat, without texture, but it can be unfolded");
        assert!(has_grid(arch.uv(from_above.clone())), "a distorted texture");
        let flat_dome = raised_by(|at| -0.5 * at.length_squared());
        assert!(has_grid(flat_dome.clone().uv(from_above.clone())), "a texture like the shape");
        let dome = raised_by(|at| -3.0 * at.length_squared());
        assert!(!has_grid(dome.clone()), "a dome");
        assert!(!has_grid(dome.uv(from_above)), "a distorted texture");
        let doubled: Vec<Vec3> =
            disk(8).positions().iter().chain(disk(8).positions()).copied().collect();
        let count = doubled.len() as u32 / 2;
        let twice = indices.iter().copied().chain(indices.iter().map(|at| at + count)).collect();
        let overlapping = FabricBuilder::new(doubled, twice).weld_distance(0.0);
        assert!(!has_grid(overlapping), "two disks at one place");
        assert!(!has_grid(disk(2)), "small");
        // Some vertices lie near a node, and others between nodes.
        let pinned =
            [true, false].map(|held| (0..60).any(|at| has_grid(disk(8).pin([at])) == held));
        assert_eq!(pinned, [true; 2]);
        assert!(!has_grid(FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0))), "a grid");
    }

    #[test]
    fn rows_run_along_the_warp() {
        for warp in [Vec2::X, Vec2::Y] {
            let uv = |at: &Vec3| Vec2::new(warp.dot(at.truncate()), warp.perp_dot(at.truncate()));
            let uv = disk(8).positions().iter().map(uv).collect();
            let fabric = disk(8).uv(uv).build().expect("a good fabric");
            let background = fabric.background().expect("a flat mesh has a grid");
            assert!((background.warp_cos2 - 1.0).abs() < 1e-3, "{}", background.warp_cos2);
            let nodes = background.fabric.rest_positions();
            let row = (nodes[1] - nodes[0]).normalize();
            assert!(row.dot(warp.extend(0.0)).abs() > 0.999, "{row} for a warp along {warp}");
        }
    }
}
