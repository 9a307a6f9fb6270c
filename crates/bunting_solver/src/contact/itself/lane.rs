//! Contacts of the cloth in a lane with itself.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_fabric::LaneFabric;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::pairs::{EdgeTriangle, Pairs};
use crate::contact::itself::particles::Particles;
use crate::contact::itself::rigid_zones::RigidZones;
use crate::contact::itself::separate::Spacing;
use crate::contact::itself::settings::SelfCollision;
use crate::contact::itself::state::SelfContacts;
use crate::contact::itself::untangle::untangle;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Keeps a cloth from passing through itself, or lets it.
    pub fn set_self_collision(&mut self, cloth: usize, settings: Option<SelfCollision>) {
        let Some(state) = &mut self.lanes[cloth] else { return };
        match (&mut state.self_contacts, settings) {
            (Some(contacts), Some(settings)) => contacts.settings = settings,
            (contacts, None) => *contacts = None,
            (contacts, Some(settings)) => {
                let LaneFabric { fabric, contact_mesh, .. } =
                    &mut self.fabrics[Y::fabric_of(cloth)];
                let mesh = contact_mesh.get_or_insert_with(|| Arc::new(ContactMesh::of(fabric)));
                let count = fabric.particle_count();
                *contacts = Some(Box::new(SelfContacts::new(Arc::clone(mesh), count, settings)));
            }
        }
    }

    /// Finds the features of a cloth that come near one another, and moves them apart.
    pub(in crate::contact) fn separate_layers(&mut self, cloth: usize, state: &mut LaneState) {
        let Some(contacts) = state.self_contacts.as_deref_mut() else { return };
        self.gather_particles(cloth, contacts);
        let SelfContacts { settings, mesh, search, pairs, particles, .. } = contacts;
        let thickness = settings.thickness;
        search.find(Cloth { mesh, particles, thickness }, pairs);
        if pairs.is_empty() {
            return;
        }
        let SelfContacts { settings, mesh, pairs, particles, contacts: touching, tangles, .. } =
            contacts;
        particles.before.clone_from(&particles.end);
        particles.mark_near(pairs);
        self.gather_velocities(cloth, particles);
        let step = self.clock.step;
        untangle(mesh, pairs, particles, step, tangles);
        let spacing = Spacing {
            thickness: settings.thickness,
            friction: state.material.surface_friction,
            step,
            rest: self.fabric_of(cloth).fabric.rest_positions(),
            tangles,
        };
        spacing.separate(pairs, particles, touching);
        self.scatter_particles(cloth, particles);
    }

    /// Returns features that pass through one another to where they began in the substep.
    pub(in crate::contact) fn return_layers(&mut self, cloth: usize, state: &mut LaneState) {
        let Some(contacts) = state.self_contacts.as_deref_mut() else { return };
        if contacts.pairs.is_empty() {
            return;
        }
        let SelfContacts { settings, mesh, search, pairs, particles, tangles, .. } = contacts;
        let thickness = settings.thickness;
        self.layout.read(self.positions.packs_mut(), cloth, &mut particles.end);
        particles.touched.fill(false);
        particles.before.clone_from(&particles.end);
        if search.is_outdated(Cloth { mesh, particles, thickness }) {
            search.find(Cloth { mesh, particles, thickness }, pairs);
        }
        let mut zones = RigidZones::new(particles);
        let mut grew = false;
        while zones.grow(pairs, tangles, particles) {
            grew = true;
            let cloth = Cloth { mesh, particles, thickness };
            if !search.is_outdated(cloth) {
                break;
            }
            search.find(cloth, pairs);
        }
        if grew {
            particles.is_near.clone_from(&particles.touched);
            self.gather_velocities(cloth, particles);
            zones.stop(particles);
            self.scatter_particles(cloth, particles);
        }
        if self.parameters.is_near_rest(Y::lanes(cloth)) {
            self.suspend_relaxation(cloth, pairs);
        }
    }

    /// Exempts particles that are near other features from under-relaxation, which would move them after the contacts:
    /// sets their factors to one, and their oldest velocities such that they have not reversed.
    fn suspend_relaxation(&mut self, cloth: usize, pairs: &Pairs) {
        for particle in pairs.edges_triangles.iter().flat_map(EdgeTriangle::particles) {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            self.relaxation[pack].lanes_mut()[lane] = 1.0;
            let velocity = lane3(&self.older_velocity[pack], lane);
            set_lane3(&mut self.oldest_velocity[pack], lane, velocity);
        }
    }

    /// Copies positions and masses of a cloth out of the lanes.
    fn gather_particles(&mut self, cloth: usize, contacts: &mut SelfContacts) {
        let Particles { start, end, touched, inverse_mass, .. } = &mut contacts.particles;
        self.layout.read(&self.scratch, cloth, start);
        self.layout.read(self.positions.packs_mut(), cloth, end);
        touched.fill(false);
        for (particle, inverse_mass) in inverse_mass.iter_mut().enumerate() {
            let (pack, lane) = self.layout.locate(particle, cloth);
            *inverse_mass = self.masses.inverse[pack].lanes()[lane];
        }
    }

    /// Copies velocities of particles that are near others out of the lanes, with corrections to the positions before this
    /// phase.
    fn gather_velocities(&self, cloth: usize, particles: &mut Particles) {
        particles.impact.fill(Vec3::ZERO);
        let inverse_step = 1.0 / self.parameters.step.lanes()[Y::lanes(cloth).start];
        for particle in 0..particles.is_near.len() {
            if !particles.is_near[particle] {
                continue;
            }
            let (pack, lane) = self.layout.locate(particle, cloth);
            let predicted = particles.start[particle] + lane3(&self.displacement[pack], lane);
            let correction = particles.before[particle] - predicted;
            particles.velocity[particle] =
                lane3(&self.velocity[pack], lane) + correction * inverse_step;
            particles.past_velocity[particle] = lane3(&self.older_velocity[pack], lane);
        }
    }

    /// Copies what contacts have changed back into the lanes. A correction of the position is no velocity: that of a
    /// particle is the one that the contacts gave to it. An impact is not extrapolated, so the velocities of the last
    /// substeps change by the same amount.
    fn scatter_particles(&mut self, cloth: usize, particles: &Particles) {
        let inverse_step = 1.0 / self.parameters.step.lanes()[Y::lanes(cloth).start];
        for particle in 0..particles.end.len() {
            if !particles.touched[particle] || particles.inverse_mass[particle] == 0.0 {
                continue;
            }
            let (pack, lane) = self.layout.locate(particle, cloth);
            let predicted = particles.start[particle] + lane3(&self.displacement[pack], lane);
            let end = particles.end[particle];
            set_lane3(&mut self.positions.packs_mut()[pack], lane, end);
            let velocity = particles.velocity[particle] - (end - predicted) * inverse_step;
            set_lane3(&mut self.velocity[pack], lane, velocity);
            for past in [&mut self.older_velocity[pack], &mut self.oldest_velocity[pack]] {
                let changed = lane3(past, lane) + particles.impact[particle];
                set_lane3(past, lane, changed);
            }
        }
    }
}
