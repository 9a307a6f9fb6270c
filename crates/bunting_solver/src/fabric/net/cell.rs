//! Cells between nodes.

use glam::Vec3;

/// A quad of two triangles, or a triangle without partner.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// Counter-clockwise.
    pub nodes: Vec<u32>,
    pub triangles: Vec<u32>,
}

impl Cell {
    /// The ends of each side.
    pub fn sides(&self) -> impl Iterator<Item = [u32; 2]> {
        let count = self.nodes.len();
        (0..count).map(move |at| [self.nodes[at], self.nodes[(at + 1) % count]])
    }

    /// Each node between those before and after it.
    pub fn threes(&self) -> impl Iterator<Item = [u32; 3]> {
        let count = self.nodes.len();
        (0..count).map(move |at| [0, 1, 2].map(|by| self.nodes[(at + by) % count]))
    }

    /// m².
    pub fn area(&self, positions: &[Vec3]) -> f32 {
        let at = |node: usize| positions[self.nodes[node] as usize];
        match self.nodes.len() {
            4 => 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).length(),
            _ => 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).length(),
        }
    }
}
