//! Sums of what cloths do to their pins.

use glam::Vec3;

use crate::anchors::pin_groups::carrying_links;
use crate::anchors::pin_reports::{PinReaction, PinReports};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;
use crate::step::clock::Clock;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Forgets the sums of the tick before.
    pub fn begin_pin_reports(&mut self) {
        for state in self.lanes.iter_mut().flatten() {
            if let Some(reports) = &mut state.pin_reports {
                reports.begin_tick();
            }
            if let Some(holds) = &mut state.holds {
                holds.begin_tick();
            }
        }
    }

    /// Adds the air on the pins in this substep. Called between `gather_air` and the prediction, while `scratch` holds the
    /// air. Pins are not moved by it, so that its explicit change of velocity is exact.
    pub fn sum_air_on_pins(&mut self) {
        for cloth in 0..self.lanes.len() {
            self.with_reports(cloth, |batch, state, reports| {
                let density = state.material.area_density;
                batch.add_at_pins(cloth, state, reports, |batch, _, particle| {
                    density * batch.vector(&batch.scratch, particle, cloth)
                });
            });
        }
    }

    /// Adds the push of the air inside cloths on the pins in this substep. Called when it has been measured.
    pub fn sum_inner_air_on_pins(&mut self) {
        for cloth in 0..self.lanes.len() {
            self.with_reports(cloth, |batch, state, reports| {
                let Some(inner) = &state.inner_air else { return };
                let rate = state.history.pressure.unwrap_or_default() * batch.clock.step;
                batch.add_at_pins(cloth, state, reports, |_, _, particle| {
                    inner.gradient[particle] * rate
                });
            });
        }
    }

    /// Adds what the constraints do to the pins in this substep: the opposite of what they do to the free particles. Called
    /// after all of them, and before the contacts, which come from outside. At the end of the tick, weight and inertia of
    /// the pins themselves are added.
    pub fn sum_reactions(&mut self) {
        self.finish_holds();
        for cloth in 0..self.lanes.len() {
            self.with_reports(cloth, |batch, state, reports| {
                batch.add_corrections(cloth, state, reports);
                if batch.clock.begun == batch.clock.settings.substeps {
                    batch.add_weight_of_pins(cloth, state, reports);
                }
            });
        }
    }

    /// Calls `sum` if reactions of the cloth are asked for. Its state is taken out, so that the batch can be read.
    fn with_reports(
        &mut self,
        cloth: usize,
        sum: impl FnOnce(&mut Self, &LaneState, &mut PinReports),
    ) {
        let asks = |state: &mut LaneState| state.pin_reports.is_some();
        let Some(mut state) = self.lanes[cloth].take_if(asks) else { return };
        if let Some(mut reports) = state.pin_reports.take() {
            sum(self, &state, &mut reports);
            state.pin_reports = Some(reports);
        }
        self.lanes[cloth] = Some(state);
    }

    /// Adds an impulse at each pin, N·s along the axes in this substep, given its index in the groups and its particle.
    fn add_at_pins(
        &mut self,
        cloth: usize,
        state: &LaneState,
        reports: &mut PinReports,
        impulse: impl Fn(&Self, usize, usize) -> Vec3,
    ) {
        self.positions.packs_mut();
        let groups = reports.groups.clone();
        let mut sums = vec![PinReaction::default(); groups.count];
        let (index, part) = self.substep_and_part();
        for (pin, &(group, particle)) in groups.pins.iter().enumerate() {
            let at = self.vector(self.positions.packs(), particle as usize, cloth);
            let impulse = impulse(self, pin, particle as usize);
            sums[group].add(at - reports.pivot(group, part), impulse);
        }
        self.add_turned(state, reports, index, &sums);
    }

    /// Index of the substep under way, and the part of the tick that has passed at its end.
    fn substep_and_part(&self) -> (u32, f32) {
        let Clock { begun, predicted, settings, .. } = self.clock;
        let index = if predicted { begun - 1 } else { begun };
        (index, (index + 1) as f32 / settings.substeps as f32)
    }

    /// Adds reactions along the axes of the frame in a substep.
    fn add_turned(
        &self,
        state: &LaneState,
        reports: &mut PinReports,
        index: u32,
        reactions: &[PinReaction],
    ) {
        let turn = state.drive.motion.turn_to_end(index, self.clock.settings.substeps);
        for (sum, &reaction) in reports.sums.iter_mut().zip(reactions) {
            sum.add_turned(reaction, turn);
        }
    }

    fn add_corrections(&mut self, cloth: usize, state: &LaneState, reports: &mut PinReports) {
        self.positions.packs_mut();
        let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
        let groups = reports.groups.clone();
        let (index, part) = self.substep_and_part();
        let pivots: Vec<Vec3> = (0..groups.count).map(|group| reports.pivot(group, part)).collect();
        let mut sums = vec![PinReaction::default(); groups.count];
        let mut add = |shares: &dyn Fn(usize) -> f32, at: Vec3, impulse: Vec3| {
            for (group, sum) in sums.iter_mut().enumerate() {
                let share = shares(group);
                if share != 0.0 {
                    sum.add(at - pivots[group], impulse * share);
                }
            }
        };
        let step = self.clock.step;
        let effective = self.parameters.step.lanes()[Y::lanes(cloth).start];
        // A steady force acts for the whole substep, of which the formula takes β.
        let rate = state.material.area_density * step / (effective * effective);
        let positions = self.positions.packs();
        let pole = self.pole_of(cloth);
        let turn = state.history.pole_turn.angle;
        for particle in 0..fabric.particle_count() {
            let (pack, lane) = self.layout.locate(particle, cloth);
            let at = lane3(&positions[pack], lane);
            let start = lane3(&self.scratch[pack], lane);
            // A spurious turn of the substep before is undone by the prediction, and by no force.
            let undone = pole.map_or(Vec3::ZERO, |pole| pole.turned(start, turn));
            let predicted = start + lane3(&self.displacement[pack], lane) + undone;
            let inertia = self.masses.inertia[pack].lanes()[lane];
            let share = |group: usize| groups.shares.get(group).map_or(1.0, |of| of[particle]);
            add(&share, at, (predicted - at) * (inertia * rate));
        }
        // What holds do to the free particles comes from outside.
        for (hold, given) in state.holds.iter().flat_map(|holds| holds.given()) {
            let at = self.vector(positions, hold as usize, cloth);
            let share = |group: usize| groups.shares.get(group).map_or(1.0, |of| of[hold as usize]);
            add(&share, at, given * rate);
        }
        if groups.count > 1 {
            for link in carrying_links(fabric, &state.material) {
                let [a, b] = link.particles.map(|particle| particle as usize);
                let [from, to] = [a, b].map(|at| self.vector(positions, at, cloth));
                let along = to - from;
                let length = along.length();
                let tension = link.stiffness * (length - link.rest_length) * step;
                let pull = along * (tension / length.max(f32::MIN_POSITIVE));
                // What the link carries from the particles of one share to those of another.
                let difference = |group: usize| groups.shares[group][a] - groups.shares[group][b];
                add(&difference, 0.5 * (from + to), pull);
            }
        }
        self.add_turned(state, reports, index, &sums);
    }

    fn add_weight_of_pins(&mut self, cloth: usize, state: &LaneState, reports: &mut PinReports) {
        let tick = self.clock.step * self.clock.settings.substeps as f32;
        let groups = reports.groups.clone();
        let velocity =
            |&(_, particle): &(usize, u32)| self.vector(&self.velocity, particle as usize, cloth);
        let velocities = groups.pins.iter().map(velocity).collect();
        let changes = reports.changes(velocities, state.drive.motion.rotation);
        let density = state.material.area_density;
        self.add_at_pins(cloth, state, reports, |batch, pin, particle| {
            let area = batch.fabric_of(cloth).fabric.particle_areas()[particle];
            (state.drive.gravity * tick - changes[pin]) * (density * area)
        });
    }
}
