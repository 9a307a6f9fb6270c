//! The contacts of one cloth with itself, from one phase of a substep to another.

use std::sync::Arc;

use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::search::Search;
use crate::contact::itself::separate::Contact;
use crate::contact::itself::settings::SelfCollision;
use crate::contact::itself::untangle::Tangles;

/// The contacts of one cloth with itself. All but the settings and the mesh are scratch arrays of a substep.
#[derive(Clone, Debug)]
pub(crate) struct SelfContacts {
    pub settings: SelfCollision,
    pub(super) mesh: Arc<ContactMesh>,
    pub(super) search: Search,
    pub(super) pairs: Pairs,
    pub(super) particles: Particles,
    pub(super) contacts: Vec<Contact>,
    pub(super) tangles: Tangles,
}

impl SelfContacts {
    /// No contacts yet of a cloth with a number of particles.
    pub fn new(mesh: Arc<ContactMesh>, count: usize, settings: SelfCollision) -> Self {
        let mut particles = Particles::default();
        particles.resize(count);
        Self {
            settings,
            mesh,
            search: Search::default(),
            pairs: Pairs::default(),
            particles,
            contacts: Vec::new(),
            tangles: Tangles::default(),
        }
    }
}
