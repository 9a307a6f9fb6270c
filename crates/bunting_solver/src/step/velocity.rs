//! Velocities from corrected positions: the thesis's `v = (p − x)/Δt`.
//!
//! With p̃ and ṽ the predicted position and velocity, this equals ṽ + (p − p̃)/Δt, and is computed in this
//! form: the difference p − x would round ṽ to a unit in the last place of x over Δt, and lose accelerations
//! smaller than that.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::stability::pole::{Axis, Moment, PolePacks, PoleTurn};
use crate::stability::relaxation::UnderRelaxation;
use crate::step::Scheme;
use crate::step::parameters::Parameters;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Ends a substep: computes velocities from the corrected positions.
    pub fn update_velocities(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        let has_chains = self.clock.settings.scheme == Scheme::Yarns;
        let turns = has_chains && self.numbers.pole.is_some();
        let mut turn = self.external_moments();
        self.suspend_relaxation_of_seams();
        self.correct_velocities(turns, &mut turn);
        if turns {
            self.store_pole_turn(&turn);
        }
        self.damp_internally();
        if has_chains {
            self.keep_spin();
        }
        self.clock.predicted = false;
    }

    /// Computes velocities from the corrected positions. `turn` is that of [`UpdateVelocities`], if the turn about the
    /// pole is wanted.
    pub(super) fn correct_velocities(&mut self, turns: bool, turn: &mut P) {
        P::run(UpdateVelocities {
            pole: self.numbers.pole.as_ref().filter(|_| turns),
            turn,
            inertias: &self.masses.inertia,
            partial_sums: &self.partial_sums,
            inverse_areas: &self.masses.inverse_areas,
            parameters: &self.parameters,
            relaxation: &mut self.relaxation,
            position: self.positions.packs_mut(),
            start: &self.scratch,
            displacement: &mut self.displacement,
            older_displacement: &self.older_displacement,
            velocity: &mut self.velocity,
            past_velocities: [&self.older_velocity, &self.oldest_velocity],
        });
    }

    /// Moments about the pole of corrections from outside the cloths, m⁴.
    fn external_moments(&self) -> P {
        let mut moments = P::splat(0.0);
        for (cloth, state) in self.lanes.iter().enumerate() {
            if let Some(state) = state {
                moments.lanes_mut()[Y::lanes(cloth)].fill(state.external_moment);
            }
        }
        moments
    }

    /// Stores the turns of the cloths about the pole by the corrections, rad.
    fn store_pole_turn(&mut self, turn: &P) {
        for (cloth, state) in self.lanes.iter_mut().enumerate() {
            if let Some(state) = state {
                let lane = Y::lanes(cloth).start;
                let rate = self.parameters.inverse_step.lanes()[lane];
                state.store_pole_turn(turn.lanes()[lane], rate);
            }
        }
    }
}

impl LaneState {
    /// Stores the turn about the pole by the corrections, rad, given the rate at which corrections become velocities, 1/s.
    pub fn store_pole_turn(&mut self, angle: f32, inverse_step: f32) {
        // The pole is that of pins in their places at rest, and guides turn the cloth from outside.
        let rests = self.moving_pins.is_empty() && self.are_pins_at_rest;
        let turns = rests && self.guides.is_none();
        let angle = if turns { angle } else { 0.0 };
        self.history.pole_turn = PoleTurn { angle, rate: angle * inverse_step };
    }
}

struct UpdateVelocities<'a, P: Pack, C> {
    pole: Option<&'a PolePacks<P>>,
    /// Before: moments about the pole of corrections from outside the cloths, m⁴. After: turns by all other
    /// corrections, rad.
    turn: &'a mut P,
    inertias: &'a [P],
    partial_sums: &'a [u8],
    inverse_areas: &'a [C],
    parameters: &'a Parameters<P>,
    relaxation: &'a mut [P],
    position: &'a mut [Pack3<P>],
    /// Positions at the start of the substep, m.
    start: &'a [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    older_displacement: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    /// Velocities at the start of the substep and of the one before, m/s.
    past_velocities: [&'a [Pack3<P>]; 2],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for UpdateVelocities<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, &self.parameters.inverse_step);
        let axis = Axis::<L>::load(token, self.pole);
        let mut moment = Moment::new(token);
        let under_relaxation = UnderRelaxation::<L>::load(token, self.parameters);
        let [older_velocity, oldest_velocity] = self.past_velocities;
        let positions = self.position.iter_mut().zip(self.start);
        let displacements = self.displacement.iter_mut().zip(self.older_displacement);
        let velocities = self.velocity.iter_mut().zip(older_velocity.iter().zip(oldest_velocity));
        let masses = self.inverse_areas.iter().zip(self.inertias).zip(self.partial_sums);
        for (
            (((position, start), (displacement, older_displacement)), (velocity, past_velocities)),
            (((inverse_area, inertia), &partial_sum), relaxation),
        ) in positions.zip(displacements).zip(velocities).zip(masses.zip(self.relaxation))
        {
            if inverse_area.is_zero() {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let moved: V3<L> = V3::load(token, displacement);
            let v: V3<L> = V3::load(token, velocity);
            let correction = x - (V3::load(token, start) + moved);
            if let Some(axis) = &axis {
                let inertia = L::load(token, inertia);
                moment.add(partial_sum, inertia, axis.turn_of(x), correction);
            }
            let mut change = moved + correction;
            let mut corrected = v.plus_scaled(correction, inverse_step);
            if let Some(under_relaxation) = &under_relaxation
                && let Some(relaxed) =
                    under_relaxation.relax(token, corrected, past_velocities, relaxation)
            {
                let excess = relaxed.excess(token, change, V3::load(token, older_displacement));
                inverse_area.select3(token, x - excess, x).store(position);
                change = change - excess;
                let before = V3::load(token, past_velocities.0);
                corrected = corrected - relaxed.excess(token, corrected, before);
            }
            inverse_area.select3(token, change, moved).store(displacement);
            inverse_area.select3(token, corrected, v).store(velocity);
        }
        if axis.is_some() {
            moment.turn::<C>(token, L::load(token, self.turn)).store(self.turn);
        }
    }
}
