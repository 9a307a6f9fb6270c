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
use crate::contact::itself::rounds::{Lanes, Rounds};
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

    /// Keeps the layers of a cloth apart from one another, and the cloth from its colliders.
    pub(in crate::contact) fn solve_layers(
        &mut self,
        cloth: usize,
        state: &mut LaneState,
        contacts: &mut SelfContacts,
    ) {
        let SelfContacts { settings: SelfCollision { thickness }, mesh, layers } = contacts;
        self.gather_particles(cloth, &mut layers.particles);
        if self.clock.begun == 1 {
            layers.begin_tick();
        }
        let fabric = Arc::clone(&self.fabric_of(cloth).fabric);
        let friction = state.material.surface_friction;
        let sewn = state.seams.as_ref().map_or_else(Vec::new, |seams| seams.joined_particles());
        let rules = OfOneCloth {
            thickness: *thickness,
            friction,
            rest: fabric.rest_positions(),
            sewn: &sewn,
        };
        let rounds = Rounds {
            mesh,
            rules: &rules,
            thickness: *thickness,
            step: self.clock.step,
            sweeps: SWEEPS,
        };
        let part = Part { cloth, range: 0..layers.particles.end.len(), place: &InItsFrame };
        rounds.solve(layers, &mut OwnLane { batch: self, state, part });
        self.suspend_relaxation(cloth, layers.unrelaxed_particles(*thickness));
    }

    /// Copies positions and masses of a cloth out of the lanes.
    fn gather_particles(&mut self, cloth: usize, particles: &mut Particles) {
        let Particles { start, end, touched, inverse_mass, .. } = particles;
        self.layout.read(&self.scratch, cloth, start);
        for pin in self.fabric_of(cloth).fabric.pins() {
            start[pin.particle as usize] = self.start_of(cloth, pin.particle);
        }
        self.layout.read(self.positions.packs_mut(), cloth, end);
        touched.fill(false);
        self.layout.read_numbers(&self.masses.inverse, cloth, inverse_mass);
    }
}

/// The lane of a cloth that touches itself.
struct OwnLane<'a, P: Pack, Y: Layout<P>> {
    batch: &'a mut LaneBatch<P, Y>,
    state: &'a mut LaneState,
    part: Part<'a, InItsFrame>,
}

impl<P: Pack, Y: Layout<P>> Lanes for OwnLane<'_, P, Y> {
    fn read_velocities(&mut self, particles: &mut Particles) {
        self.batch.gather_velocities(&self.part, particles);
    }

    fn write(&mut self, particles: &Particles) {
        self.state.external_moment += self.batch.scatter_particles(&self.part, particles);
    }

    fn touch_colliders(&mut self, particles: &mut Particles) -> bool {
        self.batch.touch_colliders(&self.part, self.state, particles)
    }
}
