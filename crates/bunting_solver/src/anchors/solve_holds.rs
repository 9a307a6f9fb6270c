//! Holds, solved with the cloth: implicit springs.
//!
//! A spring of stiffness k to a place p moves a particle of mass m, which would go to x̃, to x̂ = (m x̃ + k τ² p)/(m + k τ²)
//! in a substep of effective length τ, and makes it as hard to move as a mass m + k τ². Constraints that start from x̂ with
//! that mass solve the spring exactly with the cloth, whatever its stiffness: a particle that only the spring held would be
//! stretched by the solver's own compliance.
//!
//! A ring on a rail is a spring to the nearest point of the rail, which has no force along it, with the stiffness that gives
//! it the ring's mass. What the constraints move it off the rail is then taken back.

use glam::Vec3;

use crate::anchors::hold::{Holder, nearest};
use crate::anchors::holds::{Held, Holds};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

/// Speed at which rings that are off their rail come to it, m/s. Smaller: rings of cloth that is flung leave the rail.
/// Larger: cloth that is put on a rail jumps.
const REACH_SPEED: f32 = 2.0;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Gives held particles their own masses for the prediction.
    pub fn free_held(&mut self) {
        for cloth in 0..self.lanes.len() {
            let Some(state) = &self.lanes[cloth] else { continue };
            let Some(holds) = &state.holds else { continue };
            for hold in &holds.list {
                let (pack, lane) = self.layout.locate(hold.particle as usize, cloth);
                let inertia = self.masses.inertia[pack].lanes()[lane];
                self.masses.inverse[pack].lanes_mut()[lane] = inverse(inertia);
            }
        }
    }

    /// Draws held particles from their predicted positions towards their places, and gives them the holds' inertia.
    pub fn draw_held(&mut self) {
        for cloth in 0..self.lanes.len() {
            self.with_holds(cloth, |batch, state, holds| batch.draw_held_of(cloth, state, holds));
        }
    }

    /// Puts rings back on their rails, with friction, and sums what the holds do. Called after all constraints.
    pub fn finish_holds(&mut self) {
        for cloth in 0..self.lanes.len() {
            self.with_holds(cloth, |batch, state, holds| {
                batch.finish_holds_of(cloth, state, holds)
            });
        }
    }

    /// Calls `solve` with the state of a cloth that has holds, which is taken out, so that the batch can be written.
    fn with_holds(
        &mut self,
        cloth: usize,
        solve: impl FnOnce(&mut Self, &mut LaneState, &mut Holds),
    ) {
        let has_holds = |state: &mut LaneState| state.holds.is_some();
        let Some(mut state) = self.lanes[cloth].take_if(has_holds) else { return };
        if let Some(mut holds) = state.holds.take() {
            solve(self, &mut state, &mut holds);
            state.holds = Some(holds);
        }
        self.lanes[cloth] = Some(state);
    }

    fn draw_held_of(&mut self, cloth: usize, state: &LaneState, holds: &mut Holds) {
        let effective = self.parameters.step.lanes()[Y::lanes(cloth).start];
        let density = state.material.area_density;
        let part = (self.clock.begun + 1) as f32 / self.clock.settings.substeps as f32;
        let particles = self.fabric.particle_count();
        let mut inverse_masses: Vec<f32> = Vec::with_capacity(particles);
        for particle in 0..particles {
            let (pack, lane) = self.layout.locate(particle, cloth);
            inverse_masses.push(self.masses.inverse[pack].lanes()[lane]);
        }
        holds.now.clear();
        for hold in &holds.list {
            let particle = hold.particle as usize;
            let (pack, lane) = self.layout.locate(particle, cloth);
            let own = self.masses.inertia[pack].lanes()[lane];
            if own == 0.0 {
                holds.now.push(None);
                continue;
            }
            let predicted = lane3(&self.positions.packs_mut()[pack], lane);
            let mut place = hold.by.place(part, predicted);
            if matches!(hold.by, Holder::Ring { .. }) {
                place = towards(predicted, place, REACH_SPEED * self.clock.step);
            }
            let added = match hold.by {
                Holder::Spring { stiffness, max_force, .. } => {
                    let stretch = place.distance(lane3(&self.scratch[pack], lane));
                    stiffness.min(max_force / stretch.max(f32::MIN_POSITIVE))
                        * effective
                        * effective
                }
                Holder::Ring { mass, .. } => mass,
            } / density;
            let inertia = own + added;
            let drawn = predicted + (place - predicted) * (added / inertia);
            set_lane3(&mut self.positions.packs_mut()[pack], lane, drawn);
            self.masses.inverse[pack].lanes_mut()[lane] = inverse(inertia);
            inverse_masses[particle] = inverse(inertia);
            holds.now.push(Some(Held { predicted, drawn, inertia, given: Vec3::ZERO }));
        }
        self.positions.set_inverse_masses(&inverse_masses);
    }

    fn finish_holds_of(&mut self, cloth: usize, state: &mut LaneState, holds: &mut Holds) {
        let effective = self.parameters.step.lanes()[Y::lanes(cloth).start];
        let count = self.clock.settings.substeps;
        // `integrate` has counted this substep already.
        let index = self.clock.begun - 1;
        let [before, part] = [index, index + 1].map(|substep| substep as f32 / count as f32);
        let rate = state.material.area_density * self.clock.step / (effective * effective);
        let turn = state.drive.motion.turn_to_end(index, count);
        let frame = state.drive.motion.substep(index, count);
        for at in 0..holds.list.len() {
            let Some(held) = holds.now[at] else { continue };
            let hold = &holds.list[at];
            let (pack, lane) = self.layout.locate(hold.particle as usize, cloth);
            let solved = lane3(&self.positions.packs_mut()[pack], lane);
            let own = self.masses.inertia[pack].lanes()[lane];
            let by_cloth = held.inertia * (solved - held.drawn);
            let mut end = solved;
            if let Holder::Ring { rail, friction, .. } = &hold.by {
                let (at, orientation) = hold.by.pose(part);
                let (local, along) = nearest(rail, orientation.inverse() * (solved - at));
                end = towards(solved, at + orientation * local, REACH_SPEED * self.clock.step);
                let along = orientation * along;
                let (at_before, before) = hold.by.pose(before);
                // The point of the rail where the ring was at the start of the substep.
                let start = frame.to_old(lane3(&self.scratch[pack], lane));
                let start = at + orientation * (before.inverse() * (start - at_before));
                let slid = (end - start).dot(along);
                // The rail carries the ring, too.
                let pushed = held.inertia * (end - held.predicted) - by_cloth;
                let pushed = if along == Vec3::ZERO { pushed } else { pushed.reject_from(along) };
                let stopped = (friction * pushed.length() / held.inertia).min(slid.abs());
                end -= along * (stopped * slid.signum());
            }
            set_lane3(&mut self.positions.packs_mut()[pack], lane, end);
            // All of the particle's correction that the cloth has not done.
            let given = own * (end - held.predicted) - by_cloth;
            if let Some(pole) = self.pole_of(cloth) {
                state.external_moment += pole.moment(1.0, end, given);
            }
            let by_holder = match hold.by {
                Holder::Spring { .. } => given,
                Holder::Ring { .. } => held.inertia * (end - held.predicted) - by_cloth,
            };
            holds.note(at, given, turn * (by_holder * -rate));
        }
    }
}

/// The point on the way from one to another, at most at a distance (m).
fn towards(from: Vec3, to: Vec3, distance: f32) -> Vec3 {
    from + (to - from).clamp_length_max(distance)
}

/// One over an inertia; zero if that is zero.
fn inverse(inertia: f32) -> f32 {
    if inertia > 0.0 { 1.0 / inertia } else { 0.0 }
}
