//! A point at which a mesh gets a vertex.

/// A point on a triangle of a mesh.
#[derive(Clone, Copy, Debug)]
pub(in crate::fabric) struct PointOn {
    pub triangle: u32,
    /// The weights of its corners, with the sum 1.
    pub weights: [f64; 3],
    pub is_pinned: bool,
}
