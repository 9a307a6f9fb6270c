//! Second differences of a grid that is curved at rest, in a frame of each node that turns with the cloth.
//!
//! A line of such a grid resists what its second differences are more than at rest. These are given along the normal of a
//! node, its tangent along the row, and the product of both, which are found from the node's neighbours
//! (`constraints/rest_bends.rs`). The systems of the lines stay those of a flat grid.

use glam::Vec3;

use super::fabric::Fabric;
use super::grid::Grid;
use super::links::LinkFamily;
use super::mesh::RestMesh;

/// The second differences at rest of a grid's nodes.
#[derive(Clone, Debug)]
pub(crate) struct RestBends {
    /// Of each node: second differences along its row and along its column, and the twist of the cell behind and below it,
    /// each along the normal, the tangent and the product of both, m; zero where a line ends.
    pub of_nodes: Vec<[[f32; 3]; 3]>,
    /// Of each node those before and after it in its row, and those above and below it: the node itself where the grid
    /// ends.
    pub neighbours: Vec<[u32; 4]>,
    /// Whether there is cloth around each node.
    pub has_cloth: Vec<bool>,
    /// Whether the first and the last row are at one place.
    pub is_closed: bool,
}

impl RestBends {
    /// The second differences of nodes at rest. The first and the last row of a closed grid are at one place, and a grid ends
    /// where its nodes have no area.
    pub(super) fn of(grid: &Grid, nodes: &RestMesh, is_closed: bool) -> Self {
        let positions = &nodes.positions;
        let places = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |at| (at, row)));
        let neighbours: Vec<[u32; 4]> =
            places.map(|place| grid.neighbours(place, is_closed)).collect();
        let has_cloth: Vec<bool> = nodes.areas.iter().map(|area| *area > 0.0).collect();
        let opposite = |node: u32, after: u32, below: u32| {
            // A closed grid has no cells below its last row.
            let has_cell = after != node && node / grid.columns + 1 < grid.rows;
            has_cell.then_some(below + 1)
        };
        Self::with(positions, neighbours, has_cloth, is_closed, opposite)
    }

    /// The second differences of the nodes of a net, which resists no twist.
    pub(super) fn of_neighbours(
        positions: &[Vec3],
        neighbours: Vec<[u32; 4]>,
        has_cloth: Vec<bool>,
    ) -> Self {
        Self::with(positions, neighbours, has_cloth, false, |_, _, _| None)
    }

    /// The second differences of nodes with their neighbours, given the node opposite to each one in the cell behind and below it.
    fn with(
        positions: &[Vec3],
        neighbours: Vec<[u32; 4]>,
        has_cloth: Vec<bool>,
        is_closed: bool,
        opposite: impl Fn(u32, u32, u32) -> Option<u32>,
    ) -> Self {
        let of_node = |(node, near): (u32, &[u32; 4])| {
            let at = |node: u32| positions[node as usize];
            let at_end = |other: u32| if has_cloth[other as usize] { other } else { node };
            let [before, after, above, below] = near.map(at_end);
            let (along, across) = (at(after) - at(before), at(below) - at(above));
            let normal = along.cross(across).normalize_or_zero();
            let tangent = along.normalize_or_zero();
            let product = normal.cross(tangent);
            let in_frame = |of: Vec3| [of.dot(normal), of.dot(tangent), of.dot(product)];
            let second = |first: u32, last: u32| match first == node || last == node {
                true => Vec3::ZERO,
                false => at(first) - 2.0 * at(node) + at(last),
            };
            let twist = match opposite(node, after, below) {
                Some(opposite) => at(node) - at(after) - at(below) + at(opposite),
                None => Vec3::ZERO,
            };
            [second(before, after), second(above, below), twist].map(in_frame)
        };
        let of_nodes = (0..).zip(&neighbours).map(of_node).collect();
        Self { of_nodes, neighbours, has_cloth, is_closed }
    }

    /// Whether a node has a neighbour with cloth on one of its sides: before it, after it, above and below it.
    pub fn has_neighbour(&self, node: usize, side: usize) -> bool {
        let neighbour = self.neighbours[node][side] as usize;
        neighbour != node && self.has_cloth[neighbour]
    }
}

impl Fabric {
    /// Whether the first and the last row of a background grid are at one place.
    pub(crate) fn is_closed(&self) -> bool {
        self.rest_bends().is_some_and(|rest| rest.is_closed)
    }

    /// Length of a grid's diagonals at rest, m, the mean where it is curved there; zero of other meshes.
    pub(crate) fn diagonal(&self) -> f32 {
        if self.rest_bends().is_none() {
            return self.grid().map_or(0.0, Grid::diagonal);
        }
        let diagonals = self.links().iter().filter(|it| it.family == LinkFamily::Diagonal);
        let (count, sum) =
            diagonals.fold((0.0, 0.0), |(count, sum), it| (count + 1.0, sum + it.rest_length));
        sum / f32::max(count, 1.0)
    }
}
