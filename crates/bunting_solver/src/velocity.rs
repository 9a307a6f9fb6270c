//! Velocities from corrected positions: the thesis's `v = (p − x)/Δt`.
//!
//! With p̃ and ṽ the predicted position and velocity this is ṽ + (p − p̃)/Δt, and that is how it is
//! computed: the difference p − x would round ṽ to a unit in the last place of x over Δt, and lose
//! whatever accelerates by less.

use crate::constraints::{Axis, Moment, Pole};
use crate::formula::Turned;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::places::Constant;
use crate::step::Scheme;
use crate::vector::{Pack3, V3};

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
            inverse_step: &self.parameters.inverse_step,
            position: &self.position,
            start: &self.scratch,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
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
    inverse_step: &'a P,
    position: &'a [Pack3<P>],
    start: &'a [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for UpdateVelocities<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, self.inverse_step);
        let places = self.position.iter().zip(self.start);
        let changes = self.displacement.iter_mut().zip(self.velocity);
        let axis = self.pole.map(|pole| Axis::<L>::of(token, &pole));
        let mut moment = Moment::new(token);
        let constants = self.inverse_areas.iter().zip(self.inertias).zip(self.parts);
        for (((position, start), (displacement, velocity)), ((inverse_area, inertia), &part)) in
            places.zip(changes).zip(constants)
        {
            if inverse_area.is_zero() {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let change: V3<L> = V3::load(token, displacement);
            let correction = x - (V3::load(token, start) + change);
            inverse_area.choose3(token, change + correction, change).store(displacement);
            if let Some(axis) = &axis {
                moment.add(part, L::load(token, inertia), axis.round(x), correction);
            }
            let v: V3<L> = V3::load(token, velocity);
            let corrected = v.plus_scaled(correction, inverse_step);
            inverse_area.choose3(token, corrected, v).store(velocity);
        }
        if axis.is_some() {
            moment.turn::<C>(token, L::load(token, self.turn)).store(self.turn);
        }
    }
}
