//! The net of a mesh of quads that has no background grid: clothes of several pieces, with sleeves and legs, slits, boxes.
//!
//! Such a mesh has lines already: the sides of its quads, which go on from quad to quad, along the whole cloth in most cases, around it
//! in others. They are solved as the rows and columns of a grid are, whatever their number at a node and wherever they end.
//! The net is a background grid whose nodes are the particles.
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

use super::background::{FEWEST_PARTICLES, GridTransfer, Interpolation, Term};
use super::bending::Bending;
use super::laid_yarns::{Directions, Faces};
use super::links::Links;
use super::mesh::{RestMesh, Surface};
use super::normals::vertex_normals;
use super::rest_bends::RestBends;
use super::yarns::Yarns;

/// Greatest mean zigzag of its lines, rad. Larger: lines straighten under load at two passes. At 2 × 2 sheets whose lines have
/// 0.04 and 0.09 stretch by 30 and 210 % too far where their material stretches by 10⁻⁴, by 4 and 29 % where that is 10⁻³.
const MOST_ZIGZAG: f32 = 0.07;

/// A net before it is a fabric.
pub(super) struct Net {
    /// The nodes as particles.
    pub mesh: RestMesh,
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

impl Net {
    /// The net of a mesh that consists of quads; none of others, of one whose lines zigzag, or of few particles.
    pub fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        if mesh.positions.len() < FEWEST_PARTICLES {
            return None;
        }
        let cells = cells::cells(mesh, &surface.edges)?;
        let lines = lines::lines(&cells, &mesh.positions);
        let corners = mesh.triangles.iter().map(|it| (mesh.positions_of(*it), *it));
        let normals = vertex_normals(mesh.positions.len(), corners);
        if lines::zigzag(&lines, &mesh.positions, &normals) > MOST_ZIGZAG {
            return None;
        }
        let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
        let directions = Directions::of(&faces, &surface.corner_uv);
        let transfer = identity(mesh);
        let mut mesh = mesh.clone();
        mesh.set_areas(areas(&cells, &mesh.positions));
        let (links, widths) = links::links(&mesh, &cells, &directions);
        let yarns = links::yarns(&mesh, &lines, &links);
        let (bending, rest_bends) = bending::bending(&mesh, &cells, &lines, &directions, &widths);
        let quads = cells.iter().filter_map(|cell| <[u32; 4]>::try_from(&cell.nodes[..]).ok());
        Some(Self {
            corners: quads.map(|[a, b, c, d]| [a, b, d, c]).collect(),
            transfer,
            mesh,
            links,
            yarns,
            bending,
            rest_bends,
        })
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
