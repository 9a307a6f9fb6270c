//! Velocities from corrected positions: the thesis's `v = (p − x)/Δt`.
//!
//! With p̃ and ṽ the predicted position and velocity this is ṽ + (p − p̃)/Δt, and that is how it is
//! computed: the difference p − x would round ṽ to a unit in the last place of x over Δt, and lose
//! whatever accelerates by less.

use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::places::Constant;
use crate::vector::{Pack3, V3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Ends a substep.
    pub fn update_velocities(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        P::run(UpdateVelocities {
            inverse_areas: &self.packs.inverse_areas,
            inverse_step: &self.parameters.inverse_step,
            position: &self.position,
            predicted: &self.predicted,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
        });
        self.calm_tremor();
        self.damp_internally();
    }
}

struct UpdateVelocities<'a, P: Pack, C> {
    inverse_areas: &'a [C],
    inverse_step: &'a P,
    position: &'a [Pack3<P>],
    predicted: &'a [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for UpdateVelocities<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, self.inverse_step);
        let places = self.position.iter().zip(self.predicted);
        let changes = self.displacement.iter_mut().zip(self.velocity);
        for (((position, predicted), (displacement, velocity)), inverse_area) in
            places.zip(changes).zip(self.inverse_areas)
        {
            if inverse_area.is_zero() {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let correction = x - V3::load(token, predicted);
            let change: V3<L> = V3::load(token, displacement);
            inverse_area.choose3(token, change + correction, change).store(displacement);
            let v: V3<L> = V3::load(token, velocity);
            let corrected = v.plus_scaled(correction, inverse_step);
            inverse_area.choose3(token, corrected, v).store(velocity);
        }
    }
}
