//! Contacts of the cloth in a lane with itself.

use std::sync::Arc;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_fabric::LaneFabric;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::itself::exchange::Part;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::place::InItsFrame;
use crate::contact::itself::rules::OfOneCloth;
use crate::contact::itself::settings::SelfCollision;
use crate::contact::itself::state::SelfContacts;
use crate::simd::lane::Pack;

/// Number of sweeps over all contacts. Fewer: piles of layers are pressed through one another, and return by rigid zones.
/// More: costs more.
const SWEEPS: usize = 4;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Keeps a cloth from passing through itself, or lets it.
    pub fn set_self_collision(&mut self, cloth: usize, settings: Option<SelfCollision>) {
        if self.lanes[cloth].is_none() {
            return;
        }
        let mesh = settings.map(|_| self.contact_mesh(cloth));
        let count = self.fabric.particle_count();
        let Some(state) = &mut self.lanes[cloth] else { return };
        match (&mut state.self_contacts, settings.zip(mesh)) {
            (Some(contacts), Some((settings, _))) => contacts.settings = settings,
            (contacts, None) => *contacts = None,
            (contacts, Some((settings, mesh))) => {
                *contacts = Some(Box::new(SelfContacts::new(mesh, count, settings)));
            }
        }
    }

    /// The features of a cloth's fabric that may touch.
    pub fn contact_mesh(&mut self, cloth: usize) -> Arc<ContactMesh> {
        let LaneFabric { fabric, contact_mesh, .. } = &mut self.fabrics[Y::fabric_of(cloth)];
        Arc::clone(contact_mesh.get_or_insert_with(|| Arc::new(ContactMesh::of(fabric))))
    }

    /// Finds the features of a cloth that come near one another, and moves them apart.
    pub(in crate::contact) fn separate_layers(&mut self, cloth: usize, state: &mut LaneState) {
        let friction = state.material.surface_friction;
        let Some(SelfContacts { settings, mesh, layers }) = state.self_contacts.as_deref_mut()
        else {
            return;
        };
        self.gather_particles(cloth, &mut layers.particles);
        let fabric = Arc::clone(&self.fabric_of(cloth).fabric);
        let thickness = settings.thickness;
        let rules = OfOneCloth { thickness, friction, rest: fabric.rest_positions() };
        if self.clock.begun == 1 {
            layers.begin_tick();
        }
        if layers.find(mesh, thickness, &rules) {
            let part = Part { cloth, range: 0..layers.particles.end.len(), place: &InItsFrame };
            self.gather_velocities(&part, &mut layers.particles);
            layers.untangle(mesh, self.clock.step);
            layers.gather(self.clock.step, &rules);
            layers.separate(SWEEPS);
            state.external_moment += self.scatter_particles(&part, &layers.particles);
        }
    }

    /// Returns features that pass through one another to where they began in the substep.
    pub(in crate::contact) fn return_layers(&mut self, cloth: usize, state: &mut LaneState) {
        let friction = state.material.surface_friction;
        let Some(SelfContacts { settings, mesh, layers }) = state.self_contacts.as_deref_mut()
        else {
            return;
        };
        if layers.pairs.is_empty() {
            return;
        }
        self.layout.read(self.positions.packs_mut(), cloth, &mut layers.particles.end);
        let fabric = Arc::clone(&self.fabric_of(cloth).fabric);
        let thickness = settings.thickness;
        let rules = OfOneCloth { thickness, friction, rest: fabric.rest_positions() };
        if let Some(mut zones) = layers.return_zones(mesh, thickness, &rules) {
            let part = Part { cloth, range: 0..layers.particles.end.len(), place: &InItsFrame };
            self.gather_velocities(&part, &mut layers.particles);
            zones.stop(&mut layers.particles);
            state.external_moment += self.scatter_particles(&part, &layers.particles);
        }
        self.suspend_relaxation(cloth, layers.pressed_particles());
    }

    /// Copies positions and masses of a cloth out of the lanes.
    fn gather_particles(&mut self, cloth: usize, particles: &mut Particles) {
        let Particles { start, end, touched, inverse_mass, .. } = particles;
        self.layout.read(&self.scratch, cloth, start);
        self.layout.read(self.positions.packs_mut(), cloth, end);
        touched.fill(false);
        for (particle, inverse_mass) in inverse_mass.iter_mut().enumerate() {
            let (pack, lane) = self.layout.locate(particle, cloth);
            *inverse_mass = self.masses.inverse[pack].lanes()[lane];
        }
    }
}
