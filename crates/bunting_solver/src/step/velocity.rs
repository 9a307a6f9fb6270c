//! Velocities from corrected positions: the thesis's `v = (p − x)/Δt`.
//!
//! With p̃ and ṽ the predicted position and velocity this is ṽ + (p − p̃)/Δt, and that is how it is
//! computed: the difference p − x would round ṽ to a unit in the last place of x over Δt, and lose
//! whatever accelerates by less.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::stability::pole::{Axis, Moment, Pole};
use crate::stability::relaxation::Calm;
use crate::step::Scheme;
use crate::step::bdf::Turned;
use crate::step::parameters::Parameters;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Ends a substep.
    pub fn update_velocities(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        let pole = self.pole.filter(|_| self.clock.settings.scheme == Scheme::Yarns);
        let mut turn = self.contact_moments();
        P::run(UpdateVelocities {
            pole,
            turn: &mut turn,
            inertias: &self.lane_inertias,
            parts: &self.parts,
            inverse_areas: &self.packs.inverse_areas,
            parameters: &self.parameters,
            share: &mut self.share,
            position: &mut self.position,
            start: &self.scratch,
            displacement: &mut self.displacement,
            older_displacement: &self.older_displacement,
            velocity: &mut self.velocity,
            past: [&self.older_velocity, &self.oldest_velocity],
        });
        if pole.is_some() {
            self.remember_turn(&turn);
        }
        self.damp_internally();
    }

    /// Moments of contacts about the pole.
    fn contact_moments(&self) -> P {
        let mut moments = P::splat(0.0);
        for (cloth, slot) in self.slots.iter().enumerate() {
            if let Some(slot) = slot {
                moments.lanes_mut()[C::lanes(cloth)].fill(slot.contact_moment);
            }
        }
        moments
    }

    /// Remembers what cloths have been turned by, rad.
    fn remember_turn(&mut self, turn: &P) {
        for (cloth, slot) in self.slots.iter_mut().enumerate() {
            if let Some(slot) = slot {
                let lane = C::lanes(cloth).start;
                let angle = turn.lanes()[lane];
                let rate = angle * self.parameters.inverse_step.lanes()[lane];
                slot.past.turned = Turned { angle, rate };
            }
        }
    }
}

struct UpdateVelocities<'a, P: Pack, C> {
    pole: Option<Pole>,
    /// Before, the moment of contacts about the pole; then what all else has turned the cloth by.
    turn: &'a mut P,
    /// Each particle's inertia, in units of the density, m²; zero where it is pinned.
    inertias: &'a [P],
    /// Into which part of the sums each pack goes.
    parts: &'a [u8],
    inverse_areas: &'a [C],
    parameters: &'a Parameters<P>,
    /// What part of its changes each particle follows.
    share: &'a mut [P],
    position: &'a mut [Pack3<P>],
    start: &'a [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    older_displacement: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    /// Velocities at the start of the substep and of the one before.
    past: [&'a [Pack3<P>]; 2],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for UpdateVelocities<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, &self.parameters.inverse_step);
        let axis = Axis::<L>::of(token, self.pole);
        let mut moment = Moment::new(token);
        let calm = Calm::<L>::load(token, self.parameters);
        let [older_velocity, oldest_velocity] = self.past;
        let places = self.position.iter_mut().zip(self.start);
        let displacements = self.displacement.iter_mut().zip(self.older_displacement);
        let velocities = self.velocity.iter_mut().zip(older_velocity.iter().zip(oldest_velocity));
        let constants = self.inverse_areas.iter().zip(self.inertias).zip(self.parts);
        for (
            (((position, start), (displacement, older_displacement)), (velocity, past)),
            (((inverse_area, inertia), &part), share),
        ) in places.zip(displacements).zip(velocities).zip(constants.zip(self.share))
        {
            if inverse_area.is_zero() {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let moved: V3<L> = V3::load(token, displacement);
            let v: V3<L> = V3::load(token, velocity);
            let correction = x - (V3::load(token, start) + moved);
            if let Some(axis) = &axis {
                moment.add(part, L::load(token, inertia), axis.round(x), correction);
            }
            let mut change = moved + correction;
            let mut speed = v.plus_scaled(correction, inverse_step);
            if let Some(calm) = &calm
                && let Some(lag) = calm.lag(token, speed, past, share)
            {
                let excess = lag.excess(token, change, V3::load(token, older_displacement));
                inverse_area.choose3(token, x - excess, x).store(position);
                change = change - excess;
                speed = speed - lag.excess(token, speed, V3::load(token, past.0));
            }
            inverse_area.choose3(token, change, moved).store(displacement);
            inverse_area.choose3(token, speed, v).store(velocity);
        }
        if axis.is_some() {
            moment.turn::<C>(token, L::load(token, self.turn)).store(self.turn);
        }
    }
}
