//! A point on a triangle of a mesh.

/// A point on a triangle of a mesh: the mean of its three corners with weights, which are its barycentric coordinates.
///
/// ```
/// use bunting_solver::MeshPoint;
///
/// // In the middle of a triangle, and on the edge from its first corner to the second one, a quarter of the way.
/// let middle = MeshPoint::middle([0, 1, 2]);
/// let on_edge = MeshPoint { vertices: [0, 1, 2], weights: [0.75, 0.25, 0.0] };
/// # assert_ne!(middle, on_edge);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Clone)
)]
pub struct MeshPoint {
    /// The corners of the triangle by the numbers of the mesh, in any order. Of a point [at a vertex](Self::at_vertex) only that vertex
    /// counts.
    pub vertices: [u32; 3],
    /// The weights of the corners: from 0 to 1, with the sum 1.
    pub weights: [f32; 3],
}

impl MeshPoint {
    /// The middle of the triangle between three vertices.
    #[must_use]
    pub const fn middle(vertices: [u32; 3]) -> Self {
        Self { vertices, weights: [1.0 / 3.0; 3] }
    }

    /// The point at a vertex.
    #[must_use]
    pub const fn at_vertex(vertex: u32) -> Self {
        Self { vertices: [vertex; 3], weights: [1.0, 0.0, 0.0] }
    }

    /// The vertex at which the point is; none if it lies beside the corners.
    #[must_use]
    pub fn vertex(&self) -> Option<u32> {
        let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corner = units.iter().position(|unit| *unit == self.weights)?;
        Some(self.vertices[corner])
    }
}
