//! Particles between the lanes of a batch and the contacts of layers.

use core::ops::Range;

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::itself::particles::Particles;
use crate::contact::itself::place::Place;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};
use crate::stability::relaxation::EXEMPT;

/// Factor on the inverse masses of particles that a collider has pushed in the substep, so that what lies on them
/// yields and not they (Guendelman, Bridson and Fedkiw 2003, "Nonconvex rigid bodies with stacking"). Larger: stacks
/// are pressed together.
const LIGHTNESS: f32 = 1e-3;

/// Distance of which a collider has pushed a particle, m: more than rounding to a group's frame and back.
const LEAST_PUSH: f32 = 1e-5;

/// The particles of a cloth among those of all that touch.
pub(in crate::contact) struct Part<'a, S> {
    /// The cloth's lane.
    pub cloth: usize,
    pub range: Range<usize>,
    pub place: &'a S,
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Copies velocities and ways of particles that are near others out of the lanes, with the corrections to the
    /// positions so far. A pin has the velocity of its motion.
    pub(in crate::contact) fn gather_velocities<S: Place>(
        &mut self,
        part: &Part<S>,
        particles: &mut Particles,
    ) {
        let inverse_step = self.inverse_step(part.cloth);
        let positions = self.positions.packs_mut();
        for at in part.range.clone() {
            particles.impact[at] = Vec3::ZERO;
            let is_pin = particles.inverse_mass[at] == 0.0;
            if !particles.is_near[at] && !is_pin {
                continue;
            }
            let (pack, lane) = self.layout.locate(at - part.range.start, part.cloth);
            let mut velocity = lane3(&self.velocity[pack], lane);
            if !is_pin {
                let predicted =
                    lane3(&self.scratch[pack], lane) + lane3(&self.displacement[pack], lane);
                let correction = lane3(&positions[pack], lane) - predicted;
                velocity += correction * inverse_step;
            }
            particles.velocity[at] = part.place.velocity_to_common(velocity);
            let past = lane3(&self.older_velocity[pack], lane);
            particles.past_velocity[at] = part.place.velocity_to_common(past);
            particles.past_way[at] = lane3(&self.older_displacement[pack], lane).length();
        }
    }

    /// Copies what contacts have changed back into the lanes. A correction of the position is no velocity: that of a
    /// particle is the one that the contacts gave to it. An impact is not extrapolated, so the velocities of the last
    /// substeps change by the same amount. Returns the moment of the corrections about the pole, m⁴.
    #[must_use]
    pub(in crate::contact) fn scatter_particles<S: Place>(
        &mut self,
        part: &Part<S>,
        particles: &Particles,
    ) -> f32 {
        let inverse_step = self.inverse_step(part.cloth);
        let pole = self.pole_of(part.cloth);
        let mut sum = 0.0;
        for at in part.range.clone() {
            if !particles.touched[at] || particles.inverse_mass[at] == 0.0 {
                continue;
            }
            let (pack, lane) = self.layout.locate(at - part.range.start, part.cloth);
            let predicted =
                lane3(&self.scratch[pack], lane) + lane3(&self.displacement[pack], lane);
            let end = part.place.to_frame(particles.end[at]);
            let position = &mut self.positions.packs_mut()[pack];
            if let Some(pole) = &pole {
                let inertia = self.masses.inertia[pack].lanes()[lane];
                sum += pole.gained(inertia, predicted, [lane3(position, lane), end]);
            }
            set_lane3(position, lane, end);
            let velocity = part.place.velocity_to_frame(particles.velocity[at]);
            set_lane3(&mut self.velocity[pack], lane, velocity - (end - predicted) * inverse_step);
            let impact = part.place.direction_to_frame(particles.impact[at]);
            for past in [&mut self.older_velocity[pack], &mut self.oldest_velocity[pack]] {
                let changed = lane3(past, lane) + impact;
                set_lane3(past, lane, changed);
            }
        }
        sum
    }

    /// Solves the contacts with colliders, and copies the positions after them out of the lane. Particles that these
    /// have pushed yield less to others from then on. Returns whether there are any.
    pub(in crate::contact) fn touch_colliders<S: Place>(
        &mut self,
        part: &Part<S>,
        state: &mut LaneState,
        particles: &mut Particles,
    ) -> bool {
        if state.colliders.is_empty() {
            return false;
        }
        self.solve_colliders(part.cloth, state);
        let mut has_pushed = false;
        let mut after = core::mem::take(&mut particles.after);
        self.layout.read(self.positions.packs_mut(), part.cloth, &mut after);
        for (at, &after) in part.range.clone().zip(&after) {
            let after = part.place.to_common(after);
            if particles.end[at].distance_squared(after) > LEAST_PUSH * LEAST_PUSH {
                particles.inverse_mass[at] *= LIGHTNESS;
                has_pushed = true;
            }
            particles.end[at] = after;
        }
        particles.after = after;
        has_pushed
    }

    /// Exempts particles from under-relaxation, which would move them after the contacts.
    pub(in crate::contact) fn suspend_relaxation(
        &mut self,
        cloth: usize,
        particles: impl Iterator<Item = usize>,
    ) {
        if !self.parameters.is_near_rest(Y::lanes(cloth)) {
            return;
        }
        // Only packs in which a particle is relaxed have returned from the exemption of the last substep.
        for particle in 0..self.fabric_of(cloth).fabric.particle_count() {
            let (pack, lane) = self.layout.locate(particle, cloth);
            let factor = &mut self.relaxation[pack].lanes_mut()[lane];
            *factor = factor.min(1.0);
        }
        for particle in particles {
            let (pack, lane) = self.layout.locate(particle, cloth);
            self.relaxation[pack].lanes_mut()[lane] = EXEMPT;
        }
    }

    /// Moves particles of a cloth where the contacts of a pass have pushed them. These pushes become velocities, as those of lines do: what
    /// lines respond to them does.
    pub(in crate::contact) fn push_particles(&mut self, cloth: usize, particles: &Particles) {
        let positions = self.positions.packs_mut();
        for (at, end) in particles.end.iter().enumerate().filter(|(at, _)| particles.touched[*at]) {
            let (pack, lane) = self.layout.locate(at, cloth);
            set_lane3(&mut positions[pack], lane, *end);
        }
    }

    /// Rate at which corrections of positions become velocities, 1/s.
    pub(in crate::contact) fn inverse_step(&self, cloth: usize) -> f32 {
        1.0 / self.parameters.step.lanes()[Y::lanes(cloth).start]
    }
}
