//! Places on a mesh.

use glam::DVec3;

/// A place on a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub triangle: u32,
    /// Barycentric coordinates.
    pub weights: [f64; 3],
    pub at: DVec3,
    pub normal: DVec3,
    /// The vertex that it is.
    pub vertex: Option<u32>,
}
