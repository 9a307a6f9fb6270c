//! A cloth of a group in its lane.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::contact::cloths::member::Member;
use crate::contact::itself::exchange::Part;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::place::{Place, Pose};
use crate::fabric::Fabric;
use crate::simd::lane::Pack;

/// What a group needs to know of a cloth's lane at the start of a tick.
pub(crate) struct LaneShape {
    pub(super) mesh: Arc<ContactMesh>,
    pub(super) fabric: Arc<Fabric>,
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The fabric of a lane's cloth and its features that may touch.
    pub fn lane_shape(&mut self, cloth: usize) -> LaneShape {
        LaneShape {
            mesh: self.contact_mesh(cloth),
            fabric: Arc::clone(&self.fabric_of(cloth).fabric),
        }
    }

    /// Leaves the contacts of the coming substep to the group, and copies the positions at its start out of the lane.
    pub fn begin_grouped(
        &mut self,
        cloth: usize,
        member: &mut Member,
        origin: Vec3,
        start: &mut [Vec3],
    ) {
        self.disturb(cloth);
        member.set_pose(self.part_of_tick(), origin);
        self.copy_common(cloth, &member.pose, start);
        if let Some(state) = &mut self.lanes[cloth] {
            state.is_grouped = true;
            member.friction = state.material.surface_friction;
            member.sewn =
                state.seams.as_ref().map_or_else(Vec::new, |seams| seams.joined_particles());
            let own = state.self_contacts.as_mut();
            member.own_thickness = own.map(|contacts| {
                contacts.layers.forget();
                contacts.settings.thickness
            });
        }
    }

    /// Copies the positions after all other constraints out of the lane, and the masses. Returns the length of the substep, s, and the rate at
    /// which pushes become velocities in it, 1/s; zeros if the cloth does not move in it.
    pub fn read_grouped(
        &mut self,
        cloth: usize,
        member: &mut Member,
        origin: Vec3,
        particles: &mut Particles,
    ) -> [f32; 2] {
        let range = member.range.clone();
        member.moves = self.clock.predicted;
        if member.moves {
            member.set_pose(self.part_of_tick(), origin);
            self.copy_common(cloth, &member.pose, &mut particles.end[range.clone()]);
        } else {
            let Particles { start, end, .. } = &mut *particles;
            end[range.clone()].copy_from_slice(&start[range.clone()]);
        }
        let density = self.lanes[cloth].as_ref().map_or(1.0, |it| it.material.area_density);
        let scale = if member.moves { 1.0 / density } else { 0.0 };
        for (particle, inverse_mass) in particles.inverse_mass[range.clone()].iter_mut().enumerate()
        {
            let (pack, lane) = self.layout.locate(particle, cloth);
            *inverse_mass = self.masses.inverse[pack].lanes()[lane] * scale;
        }
        let finite = |positions: &[Vec3]| positions[range.clone()].iter().all(|it| it.is_finite());
        member.is_finite =
            member.settings.is_valid() && finite(&particles.start) && finite(&particles.end);
        if member.moves { [self.clock.step, self.inverse_step(cloth)] } else { [0.0; 2] }
    }

    /// Copies velocities of particles near others out of the lane. Cloth that does not move has none.
    pub fn read_velocities(&mut self, cloth: usize, member: &Member, particles: &mut Particles) {
        let range = member.range.clone();
        if member.moves {
            self.gather_velocities(&Part { cloth, range, place: &member.pose }, particles);
        } else {
            particles.velocity[range.clone()].fill(Vec3::ZERO);
            particles.past_way[range.clone()].fill(0.0);
            particles.past_velocity[range].fill(Vec3::ZERO);
        }
    }

    /// Copies what contacts have changed back into the lane.
    pub fn write_grouped(&mut self, cloth: usize, member: &Member, particles: &Particles) {
        let range = member.range.clone();
        if member.moves && member.is_finite {
            let part = Part { cloth, range, place: &member.pose };
            let moment = self.scatter_particles(&part, particles);
            if let Some(state) = &mut self.lanes[cloth] {
                state.external_moment += moment;
            }
        }
    }

    /// Solves the contacts with colliders, and copies the positions after them out of the lane. Returns whether any
    /// collider has pushed the cloth.
    pub fn touch_colliders_grouped(
        &mut self,
        cloth: usize,
        member: &Member,
        particles: &mut Particles,
    ) -> bool {
        if !member.moves {
            return false;
        }
        let Some(mut state) = self.lanes[cloth].take() else { return false };
        let part = Part { cloth, range: member.range.clone(), place: &member.pose };
        let has_pushed = self.touch_colliders(&part, &mut state, particles);
        self.lanes[cloth] = Some(state);
        has_pushed
    }

    /// Ends the substep of a group, given the particles that are not under-relaxed.
    pub fn end_grouped(&mut self, cloth: usize, unrelaxed: impl Iterator<Item = usize>) {
        self.suspend_relaxation(cloth, unrelaxed);
        if let Some(state) = &mut self.lanes[cloth] {
            state.is_grouped = false;
        }
    }

    /// The part of the tick that has passed.
    fn part_of_tick(&self) -> f32 {
        self.clock.begun as f32 / self.clock.settings.substeps as f32
    }

    /// Copies the positions of a cloth out of its lane into the group's frame.
    fn copy_common(&mut self, cloth: usize, pose: &Pose, into: &mut [Vec3]) {
        let mut positions = Vec::with_capacity(into.len());
        self.layout.read(self.positions.packs_mut(), cloth, &mut positions);
        for (into, position) in into.iter_mut().zip(positions) {
            *into = pose.to_common(position);
        }
    }
}
