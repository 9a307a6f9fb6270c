//! Cloth whose layers may touch.

use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::points::Points;

/// Cloth whose layers may touch.
pub(in crate::contact) struct Cloth<'a> {
    pub mesh: &'a ContactMesh,
    pub points: &'a Points,
    /// Distance of layers, m.
    pub thickness: f32,
}
