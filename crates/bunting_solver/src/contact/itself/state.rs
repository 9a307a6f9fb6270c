//! The contacts of one cloth with itself.

use std::sync::Arc;

use crate::contact::itself::contacts::LayerContacts;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::settings::SelfCollision;

/// The contacts of one cloth with itself.
#[derive(Clone, Debug)]
pub(crate) struct SelfContacts {
    pub settings: SelfCollision,
    pub(in crate::contact) mesh: Arc<ContactMesh>,
    pub(in crate::contact) layers: LayerContacts,
}

impl SelfContacts {
    /// No contacts yet of a cloth with a number of particles.
    pub fn new(mesh: Arc<ContactMesh>, count: usize, settings: SelfCollision) -> Self {
        let mut layers = LayerContacts::default();
        layers.particles.resize(count);
        Self { settings, mesh, layers }
    }
}
