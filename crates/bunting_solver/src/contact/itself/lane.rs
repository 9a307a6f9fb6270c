//! Contacts of the cloth in a lane with itself.

use std::sync::Arc;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_fabric::LaneFabric;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::itself::contacts::Layers;
use crate::contact::itself::exchange::Part;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::place::InItsFrame;
use crate::contact::itself::rounds::Lanes;
use crate::contact::itself::rules::OfOneCloth;
use crate::contact::itself::settings::SelfCollision;
use crate::contact::itself::state::SelfContacts;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;

/// Number of sweeps over all contacts after the lines. None: lines beside contacts are strained by what contacts push at the end of the
/// substep alone. More: costs more.
const SWEEPS_AFTER_LINES: usize = 1;

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

    /// Begins a tick of the layers of all cloths.
    pub fn begin_layers(&mut self) {
        for state in self.lanes.iter_mut().flatten() {
            if let Some(contacts) = &mut state.self_contacts {
                contacts.layers.begin_tick();
            }
        }
    }

    /// The features of a cloth's fabric that may touch.
    pub fn contact_mesh(&mut self, cloth: usize) -> Arc<ContactMesh> {
        let LaneFabric { fabric, contact_mesh, .. } = &mut self.fabrics[Y::fabric_of(cloth)];
        Arc::clone(contact_mesh.get_or_insert_with(|| Arc::new(ContactMesh::of(fabric))))
    }

    /// Moves layers of cloths apart after the solve of their lines, as far as these do not belong to a group.
    pub fn move_all_layers_apart(&mut self) {
        for cloth in 0..self.lanes.len() {
            let touches =
                |state: &mut LaneState| state.self_contacts.is_some() && !state.is_grouped;
            let Some(mut state) = self.lanes[cloth].take_if(touches) else { continue };
            let own = state.self_contacts.take();
            state.self_contacts = own.map(|mut contacts| {
                self.move_layers_apart(cloth, &state, &mut contacts);
                contacts
            });
            self.lanes[cloth] = Some(state);
        }
    }

    fn move_layers_apart(&mut self, cloth: usize, state: &LaneState, contacts: &mut SelfContacts) {
        let SelfContacts { settings, mesh, layers: contacts } = contacts;
        // This call copies the positions back from the constraints' arrays.
        self.positions.packs_mut();
        self.gather_particles(cloth, &mut contacts.particles);
        let fabric = Arc::clone(&self.fabric_of(cloth).fabric);
        let sewn = sewn_of(state);
        let rules = rules_of(state, *settings, &fabric, &sewn);
        let layers = self.layers(cloth, mesh, &rules);
        contacts.begin(&layers);
        if contacts.move_apart(&layers, SWEEPS_AFTER_LINES) {
            self.push_particles(cloth, &contacts.particles);
        }
    }

    /// Keeps the layers of a cloth apart from one another, and the cloth from its colliders.
    pub(in crate::contact) fn solve_layers(
        &mut self,
        cloth: usize,
        state: &mut LaneState,
        contacts: &mut SelfContacts,
    ) {
        let SelfContacts { settings, mesh, layers: contacts } = contacts;
        if contacts.is_begun() {
            self.gather_positions(cloth, &mut contacts.particles);
        } else {
            self.gather_particles(cloth, &mut contacts.particles);
        }
        let fabric = Arc::clone(&self.fabric_of(cloth).fabric);
        let sewn = sewn_of(state);
        let rules = rules_of(state, *settings, &fabric, &sewn);
        let layers = self.layers(cloth, mesh, &rules);
        let part = Part { cloth, range: 0..contacts.particles.end.len(), place: &InItsFrame };
        layers.solve(contacts, &mut OwnLane { batch: self, state, part }, SWEEPS);
        self.suspend_relaxation(cloth, contacts.unrelaxed_particles(settings.thickness));
    }

    /// How the layers of a cloth are kept apart in this substep.
    fn layers<'a>(
        &self,
        cloth: usize,
        mesh: &'a ContactMesh,
        rules: &'a OfOneCloth<'a>,
    ) -> Layers<'a, OfOneCloth<'a>> {
        let OfOneCloth { thickness, .. } = *rules;
        Layers { mesh, rules, thickness, step: self.clock.step, rate: self.inverse_step(cloth) }
    }

    /// Copies positions and masses of a cloth out of the lanes.
    fn gather_particles(&mut self, cloth: usize, particles: &mut Particles) {
        let Particles { start, inverse_mass, .. } = particles;
        self.layout.read(&self.scratch, cloth, start);
        for pin in self.fabric_of(cloth).fabric.pins() {
            start[pin.particle as usize] = self.start_of(cloth, pin.particle);
        }
        self.layout.read_numbers(&self.masses.inverse, cloth, inverse_mass);
        self.gather_positions(cloth, particles);
    }

    /// Copies positions of a cloth out of the lanes, whose masses and starts have been copied before.
    fn gather_positions(&mut self, cloth: usize, particles: &mut Particles) {
        self.layout.read(self.positions.packs_mut(), cloth, &mut particles.end);
        particles.touched.fill(false);
    }
}

/// The particles that seams of a cloth join.
fn sewn_of(state: &LaneState) -> Vec<[u32; 2]> {
    state.seams.as_ref().map_or_else(Vec::new, |seams| seams.joined_particles())
}

/// The rules of a cloth by itself.
fn rules_of<'a>(
    state: &LaneState,
    SelfCollision { thickness }: SelfCollision,
    fabric: &'a Fabric,
    sewn: &'a [[u32; 2]],
) -> OfOneCloth<'a> {
    let friction = state.material.surface_friction;
    OfOneCloth { thickness, friction, rest: fabric.rest_positions(), sewn }
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
