//! What is held on one target.

use bunting_solver::MeshPoint;

/// The vertices and points of a mesh that are held on one target.
#[derive(Clone, Debug, Default)]
pub(crate) struct HeldGroup {
    pub vertices: Vec<u32>,
    /// Points beside the vertices.
    pub points: Vec<MeshPoint>,
}

impl HeldGroup {
    /// Vertices alone.
    pub fn of_vertices(vertices: Vec<u32>) -> Self {
        Self { vertices, points: Vec::new() }
    }

    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty() && self.points.is_empty()
    }

    pub fn clear(&mut self) {
        *self = Self::default();
    }
}
