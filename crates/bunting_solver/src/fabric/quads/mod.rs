//! The net of a mesh that has no background grid: clothes of several pieces, with sleeves and legs, slits, boxes, balls.
//!
//! A mesh of quads has lines already: the sides of its quads, which go on from quad to quad, along the whole cloth in most cases, around it
//! in others. They are solved as the rows and columns of a grid are, whatever their number at a node and wherever they end.
//! The net is a background grid whose nodes are the particles. If the lines zigzag, nodes lie beside the particles, and a mesh of triangles
//! gets quads on a lattice (`fabric/remesh/`).
//!
//! `cells` finds the quads among the triangles, `lines` follows their sides, `links` and `bending` measure how much cloth each side
//! stands for.

mod bending;
mod cells;
mod lines;
mod links;
#[cfg(test)]
mod tests;

use glam::Vec3;

use self::lines::Line;
use super::background::{FEWEST_PARTICLES, GridTransfer, Interpolation, Term};
use super::bending::Bending;
use super::laid_yarns::Directions;
use super::links::Links;
use super::mesh::{RestMesh, Surface};
use super::remesh::{Nodes, Source};
use super::rest_bends::RestBends;
use super::topology::Edge;
use super::yarns::Yarns;

/// Greatest mean zigzag of lines through particles, rad. Larger: lines straighten under load at two passes. At 2 × 2 sheets whose lines
/// have 0.04 and 0.09 stretch by 30 and 210 % too far where their material stretches by 10⁻⁴, by 4 and 29 % where that is 10⁻³.
const MOST_ZIGZAG: f32 = 0.03;

/// The same of a mesh without pins, whose nodes are particles always: what moves between nodes and particles would change its momentum.
const MOST_ZIGZAG_OF_FREE: f32 = 0.07;

/// Least part of the triangles of a mesh that must be halves of quads. Smaller: where cells are triangles, lines end.
const LEAST_PART: f32 = 0.9;

/// The same between the nodes of a lattice, whose other lines are straight.
const LEAST_PART_OF_LATTICE: f32 = 0.8;

/// A net before it is a fabric.
pub(super) struct Net {
    /// The nodes as particles.
    pub mesh: RestMesh,
    pub edges: Vec<Edge>,
    /// Whether each node is the particle of its number.
    pub nodes_are_particles: bool,
    pub links: Links,
    pub yarns: Yarns,
    /// The corners of each quad: the first and the last one are opposite.
    pub corners: Vec<[u32; 4]>,
    pub bending: Bending,
    pub rest_bends: RestBends,
    pub transfer: GridTransfer,
}

/// A quad of two triangles, or a triangle without partner.
#[derive(Clone, Debug)]
struct Cell {
    /// Counter-clockwise.
    nodes: Vec<u32>,
    triangles: Vec<u32>,
}

impl Cell {
    /// The ends of each side.
    fn sides(&self) -> impl Iterator<Item = [u32; 2]> {
        let count = self.nodes.len();
        (0..count).map(move |at| [self.nodes[at], self.nodes[(at + 1) % count]])
    }

    /// Each node between those before and after it.
    fn threes(&self) -> impl Iterator<Item = [u32; 3]> {
        let count = self.nodes.len();
        (0..count).map(move |at| [0, 1, 2].map(|by| self.nodes[(at + by) % count]))
    }

    /// m².
    fn area(&self, positions: &[Vec3]) -> f32 {
        let at = |node: usize| positions[self.nodes[node] as usize];
        match self.nodes.len() {
            4 => 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).length(),
            _ => 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).length(),
        }
    }
}

/// A mesh of quads and few triangles, and the lines along their sides.
struct QuadMesh {
    cells: Vec<Cell>,
    lines: Vec<Line>,
    /// Mean zigzag of the lines, rad.
    zigzag: f32,
    /// Part of the triangles that are halves of quads.
    part_of_quads: f32,
}

impl QuadMesh {
    /// That of a mesh of triangles, if the given part of its triangles are halves of quads.
    fn of(mesh: &RestMesh, edges: &[Edge], least_part: f32) -> Option<Self> {
        Self::along(cells::cells(mesh, edges, least_part)?, mesh)
    }

    fn along(cells: Vec<Cell>, mesh: &RestMesh) -> Option<Self> {
        let lines = lines::lines(&cells, &mesh.positions)?;
        let normals = mesh.normals_at(&mesh.positions);
        let zigzag = lines::zigzag(&lines, &mesh.positions, &normals);
        let quads = cells.iter().filter(|cell| cell.triangles.len() == 2).count();
        let part_of_quads = (2 * quads) as f32 / mesh.triangles.len() as f32;
        Some(Self { cells, lines, zigzag, part_of_quads })
    }

    /// Whether all cells are quads, and the lines along their sides straight.
    fn is_even(&self) -> bool {
        self.zigzag <= MOST_ZIGZAG && self.part_of_quads == 1.0
    }
}

impl Net {
    /// The net of a mesh: of its quads, with nodes beside the particles if lines through these zigzag, or of quads on a lattice. None of few
    /// particles, of a Möbius strip, of a mesh on whose lattice few cells are quads, and of uneven meshes without pins.
    pub fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        if mesh.positions.len() < FEWEST_PARTICLES {
            return None;
        }
        let source = Source::new(mesh, surface);
        let own = QuadMesh::of(mesh, source.edges, LEAST_PART);
        let most_zigzag = if mesh.has_pins() { MOST_ZIGZAG } else { MOST_ZIGZAG_OF_FREE };
        if let Some(own) = own.as_ref().filter(|own| own.zigzag <= most_zigzag) {
            let transfer = identity(mesh);
            let net = Self::new(mesh, source.edges, &source.directions, own, transfer);
            return Some(Self { nodes_are_particles: true, ..net });
        }
        if !mesh.has_pins() {
            return None;
        }
        let faired = own.and_then(|own| {
            let threes: Vec<[u32; 3]> = own.lines.iter().flat_map(Line::threes).collect();
            let nodes = Nodes::faired(&source, &threes);
            let quads = QuadMesh::along(own.cells, &nodes.mesh)?;
            cells::are_alike(&quads.cells, &nodes.mesh).then_some((nodes, quads))
        });
        let on_lattice = || {
            let nodes =
                Nodes::on_lattice(&source, source.cell_size(mesh.positions.len() as f64)).ok()?;
            let quads = QuadMesh::of(&nodes.mesh, &nodes.edges, LEAST_PART_OF_LATTICE)?;
            Some((nodes, quads))
        };
        let part_of_quads = |(_, quads): &(Nodes, QuadMesh)| quads.part_of_quads;
        let (nodes, quads) = match faired {
            Some(faired) if faired.1.is_even() => faired,
            faired => {
                let found = faired.into_iter().chain(on_lattice());
                found.max_by(|one, other| part_of_quads(one).total_cmp(&part_of_quads(other)))?
            }
        };
        let cells = quads.cells.iter().map(|cell| &cell.nodes[..]);
        let transfer = nodes.transfer(&source, cells)?;
        Some(Self::new(&nodes.mesh, &nodes.edges, &nodes.directions, &quads, transfer))
    }

    /// The net of nodes that are particles themselves, and the cells between them; none if two of their triangles face opposite
    /// ways.
    pub fn of_nodes(nodes: &Nodes) -> Option<(Self, Vec<Vec<u32>>)> {
        let quads = QuadMesh::along(cells::paired(&nodes.mesh, &nodes.edges)?, &nodes.mesh)?;
        let transfer = identity(&nodes.mesh);
        let net = Self::new(&nodes.mesh, &nodes.edges, &nodes.directions, &quads, transfer);
        let cells = quads.cells.into_iter().map(|cell| cell.nodes).collect();
        Some((Self { nodes_are_particles: true, ..net }, cells))
    }

    fn new(
        mesh: &RestMesh,
        edges: &[Edge],
        directions: &Directions,
        QuadMesh { cells, lines, .. }: &QuadMesh,
        transfer: GridTransfer,
    ) -> Self {
        let mut mesh = mesh.clone();
        mesh.set_areas(areas(cells, &mesh.positions));
        let (links, widths) = links::links(&mesh, cells, directions);
        let yarns = links::yarns(&mesh, lines, &links);
        let (bending, rest_bends) = bending::bending(&mesh, cells, lines, directions, &widths);
        let quads = cells.iter().filter_map(|cell| <[u32; 4]>::try_from(&cell.nodes[..]).ok());
        Self {
            corners: quads.map(|[a, b, c, d]| [a, b, d, c]).collect(),
            edges: edges.to_vec(),
            nodes_are_particles: false,
            transfer,
            mesh,
            links,
            yarns,
            bending,
            rest_bends,
        }
    }
}

/// Area of each node, m²: its share of each cell that it borders.
fn areas(cells: &[Cell], positions: &[Vec3]) -> Vec<f32> {
    let mut areas = vec![0.0; positions.len()];
    for cell in cells {
        let share = cell.area(positions) / cell.nodes.len() as f32;
        cell.nodes.iter().for_each(|at| areas[*at as usize] += share);
    }
    areas
}

/// Each node is a particle.
fn identity(mesh: &RestMesh) -> GridTransfer {
    let rows = |is_wanted: &dyn Fn(u32) -> bool| {
        let mut rows = Interpolation::default();
        for from in 0..mesh.positions.len() as u32 {
            rows.push(is_wanted(from).then_some(Term { from, weight: 1.0 }));
        }
        rows.grouped()
    };
    let is_free = |at: u32| !mesh.is_pinned(at);
    let mut transfer = GridTransfer {
        nodes: rows(&|_| true),
        particles: rows(&is_free),
        means: rows(&is_free),
        held: rows(&|at| mesh.is_pinned(at)),
        moved_areas: Vec::new(),
        heights: Vec::new(),
        joined: Vec::new(),
    };
    transfer.moved_areas = transfer.node_masses(&mesh.free_areas());
    transfer
}
