//! Second differences of a net that is curved at rest, in a frame of each node that turns with the cloth.
//!
//! A line of such a net resists what its second differences are more than at rest. These are given along the normal of a
//! node, its tangent along the row, and the product of both, which are found from the node's neighbours
//! (`constraints/rest_bends.rs`). The systems of the lines stay those of a flat grid.

use glam::Vec3;

/// The second differences at rest of a grid's nodes.
#[derive(Clone, Debug)]
pub(crate) struct RestBends {
    /// Of each node: second differences along its row and along its column, each along the normal, the tangent and the product
    /// of both, m; zero where a line ends.
    pub of_nodes: Vec<[[f32; 3]; 2]>,
    /// Of each node those before and after it in its row, and those above and below it: the node itself where the grid
    /// ends.
    pub neighbours: Vec<[u32; 4]>,
}

impl RestBends {
    /// The second differences of nodes with their neighbours at rest.
    pub(super) fn of(positions: &[Vec3], neighbours: Vec<[u32; 4]>) -> Self {
        let of_node = |(node, near): (u32, &[u32; 4])| {
            let at = |node: u32| positions[node as usize];
            let [before, after, above, below] = *near;
            let axes = axes(near, positions);
            let in_frame = |of: Vec3| axes.map(|axis| of.dot(axis));
            let second = |first: u32, last: u32| match first == node || last == node {
                true => Vec3::ZERO,
                false => at(first) - 2.0 * at(node) + at(last),
            };
            [second(before, after), second(above, below)].map(in_frame)
        };
        let of_nodes = (0..).zip(&neighbours).map(of_node).collect();
        Self { of_nodes, neighbours }
    }

    /// The second difference at rest of a node along its row or its column, turned with the cloth, m.
    pub fn turned(&self, node: u32, is_row: bool, positions: &[Vec3]) -> Vec3 {
        let [of_row, of_column] = self.of_nodes[node as usize];
        let axes = axes(&self.neighbours[node as usize], positions);
        let at_rest = if is_row { of_row } else { of_column };
        axes.into_iter().zip(at_rest).map(|(axis, part)| axis * part).sum()
    }

    /// Whether a node has a neighbour on one of its sides: before it, after it, above and below it.
    pub fn has_neighbour(&self, node: usize, side: usize) -> bool {
        self.neighbours[node][side] as usize != node
    }
}

/// The normal of a node, its tangent along the row, and the product of both, given its neighbours.
fn axes(neighbours: &[u32; 4], positions: &[Vec3]) -> [Vec3; 3] {
    let [before, after, above, below] = neighbours.map(|at| positions[at as usize]);
    let (along, across) = (after - before, below - above);
    let normal = along.cross(across).normalize_or_zero();
    let tangent = along.normalize_or_zero();
    [normal, tangent, normal.cross(tangent)]
}
