//! The contacts of layers, of one cloth or of several, from one phase of a substep to another.

use glam::Vec3;

use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::cull::drop_distant;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::rigid_zones::RigidZones;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::search::Search;
use crate::contact::itself::separate::{Contacts, Spacing};
use crate::contact::itself::untangle::{Tangles, untangle};

/// Part of the distance of layers by which a particle near others may move in a substep and still be under-relaxed.
/// Larger: under-relaxation moves it through others. Smaller: layers at rest tremble.
const FAST: f32 = 0.25;

/// The contacts of layers: scratch arrays of a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct LayerContacts {
    search: Search,
    pub pairs: Pairs,
    pub particles: Particles,
    contacts: Contacts,
    tangles: Tangles,
}

impl LayerContacts {
    /// Begins a tick.
    pub fn begin_tick(&mut self) {
        self.search.begin_tick();
    }

    /// Finds the features that come nearer than a thickness, m, and marks their particles. Returns whether there are any.
    pub fn find(&mut self, mesh: &ContactMesh, thickness: f32, rules: &impl Rules) -> bool {
        let Self { search, pairs, particles, contacts, .. } = self;
        let cloth = Cloth { mesh, particles, thickness };
        if !search.is_good(cloth) {
            search.find(cloth, rules, pairs);
            pairs.drop_sewn(rules.sewn());
            drop_distant(pairs, particles, thickness);
        }
        if pairs.is_empty() {
            contacts.clear();
            return false;
        }
        particles.mark_near(pairs);
        true
    }

    /// Whether particles have moved since such that pairs may be missing.
    pub fn are_outdated(&self, mesh: &ContactMesh, thickness: f32) -> bool {
        self.search.is_outdated(Cloth { mesh, particles: &self.particles, thickness })
    }

    /// Moves features that pass through one another at the start of a substep of the length `step`, s.
    pub fn untangle(&mut self, mesh: &ContactMesh, step: f32) {
        untangle(mesh, &self.pairs, &mut self.particles, step, &mut self.tangles);
    }

    /// Finds the contacts of the pairs.
    pub fn gather(&mut self, step: f32, rules: &impl Rules) {
        let Self { pairs, particles, contacts, tangles, .. } = self;
        Spacing { rules, step, tangles }.gather(pairs, particles, contacts);
    }

    pub fn separate(&mut self, sweeps: usize) {
        self.contacts.separate(&mut self.particles, sweeps);
    }

    /// Particles that must end the substep where they are: those of features that are still much nearer than they must
    /// be, those of zones that have returned, and those near others that move fast, given the distance of layers, m.
    pub fn unrelaxed_particles(&self, thickness: f32) -> impl Iterator<Item = usize> {
        let Self { contacts, pairs, particles, .. } = self;
        let stays =
            move |&at: &usize| particles.touched[at] || particles.way(at) > FAST * thickness;
        contacts.pressed_particles(particles).chain(pairs.particles().filter(stays))
    }

    /// The contacts of features that are as near as they may be, given what counts as such, m: their particles, a point of
    /// the first feature, m, and the unit normal on its side.
    pub fn touching(&self, within: f32) -> impl Iterator<Item = ([u32; 4], Vec3, Vec3)> {
        self.contacts.touching(&self.particles, within).map(|contact| {
            let first = contact.particles.iter().zip(contact.factors);
            let first = first.filter(|(_, factor)| *factor > 0.0);
            let at = |particle: u32| self.particles.end[particle as usize];
            let point = first.map(|(&particle, factor)| at(particle) * factor).sum();
            (contact.particles, point, contact.normal)
        })
    }

    /// Forgets the contacts of the last substep.
    pub fn forget(&mut self) {
        self.contacts.clear();
    }

    /// Returns features that pass through one another to where they began in the substep, and marks their particles.
    /// Returns the zones, if there are any, whose velocities must become their means.
    pub fn return_zones(
        &mut self,
        mesh: &ContactMesh,
        thickness: f32,
        rules: &impl Rules,
    ) -> Option<RigidZones> {
        let Self { search, pairs, particles, tangles, .. } = self;
        particles.touched.fill(false);
        search.find_moved(Cloth { mesh, particles, thickness }, rules, pairs);
        pairs.drop_sewn(rules.sewn());
        let mut zones = RigidZones::new(particles);
        let mut grew = false;
        while zones.grow(pairs, tangles, particles) {
            grew = true;
            if !search.find_moved(Cloth { mesh, particles, thickness }, rules, pairs) {
                break;
            }
            pairs.drop_sewn(rules.sewn());
        }
        particles.is_near.clone_from(&particles.touched);
        (grew && !zones.are_given_up()).then_some(zones)
    }
}
