//! The net between nodes: lines along the sides of quads, which go on from quad to quad, along the whole cloth in most cases, around it in
//! others. They are solved as the rows and columns of a grid are, whatever their number at a node and wherever they end.
//!
//! `cells` finds the quads among the triangles, `lines` follows their sides, `links` and `bending` measure how much cloth each side
//! stands for.

mod bending;
mod cell;
mod cells;
mod lines;
mod links;

use glam::Vec3;

use self::cell::Cell;
use super::bending::Bending;
use super::links::Links;
use super::mesh::RestMesh;
use super::regions::Variation;
use super::remesh::Nodes;
use super::rest_bends::RestBends;
use super::topology::Edge;
use super::yarns::Yarns;

/// A net before it is a fabric.
pub(super) struct Net {
    /// The nodes as particles.
    pub mesh: RestMesh,
    pub edges: Vec<Edge>,
    pub links: Links,
    pub yarns: Yarns,
    /// The corners of each quad: the first and the last one are opposite.
    pub corners: Vec<[u32; 4]>,
    pub bending: Bending,
    pub rest_bends: RestBends,
    /// Area of all nodes, m².
    pub area: f32,
    pub variation: Variation,
}

impl Net {
    /// The net of nodes, and the cells between them, given how the material varies between the nodes of cells; none if two of their
    /// triangles face opposite ways, or where the sides of cells don't make lines.
    pub fn of(
        nodes: &Nodes,
        vary: impl FnOnce(&RestMesh, Vec<Vec<u32>>) -> Variation,
    ) -> Option<(Self, Vec<Vec<u32>>)> {
        let Nodes { edges, directions, .. } = nodes;
        let mut mesh = nodes.mesh.clone();
        let cells = cells::cells(&mesh, edges)?;
        let lines = lines::lines(&cells, &mesh.positions)?;
        mesh.set_areas(areas(&cells, &mesh.positions));
        let area = mesh.areas.iter().sum();
        let variation = vary(&mesh, cells.iter().map(|cell| cell.nodes.clone()).collect());
        variation.weigh(&mut mesh);
        let (unlisted, sides) = links::links(&mesh, &cells, directions, &variation);
        let (links, yarns) = links::listed(&mesh, &lines, unlisted, &sides);
        let (bending, rest_bends) =
            bending::bending(&mesh, &cells, &lines, directions, (&sides, &variation));
        let quads = cells.iter().filter_map(|cell| <[u32; 4]>::try_from(&cell.nodes[..]).ok());
        let corners = quads.map(|[a, b, c, d]| [a, b, d, c]).collect();
        let net = Self {
            corners,
            edges: edges.clone(),
            mesh,
            links,
            yarns,
            bending,
            rest_bends,
            area,
            variation,
        };
        Some((net, cells.into_iter().map(|cell| cell.nodes).collect()))
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
