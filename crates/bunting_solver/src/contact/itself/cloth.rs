//! A cloth that may touch itself.

use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;

/// A cloth that may touch itself.
#[derive(Clone, Copy)]
pub(in crate::contact) struct Cloth<'a> {
    pub mesh: &'a ContactMesh,
    pub particles: &'a Particles,
    /// Distance of layers, m.
    pub thickness: f32,
}
