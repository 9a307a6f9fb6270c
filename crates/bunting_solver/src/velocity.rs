//! Velocities from corrected positions: the thesis's `v = (p − x)/Δt`.
//!
//! With p̃ = x + Δt ṽ the predicted position and velocity this is ṽ + (p − p̃)/Δt, and that is how it
//! is computed: the difference p − x would round ṽ to a unit in the last place of x over Δt, and lose
//! whatever accelerates by less.

use crate::fabric::Fabric;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Ends a substep.
    pub fn update_velocities(&mut self) {
        P::run(UpdateVelocities {
            fabric: &self.fabric,
            inverse_step: 1.0 / self.clock.step,
            position: &self.position,
            predicted: &self.predicted,
            velocity: &mut self.velocity,
        });
        self.damp_internally();
    }
}

struct UpdateVelocities<'a, P: Pack> {
    fabric: &'a Fabric,
    inverse_step: f32,
    position: &'a [Pack3<P>],
    predicted: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for UpdateVelocities<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::splat(token, self.inverse_step);
        let particles = self.position.iter().zip(self.predicted).zip(self.velocity);
        for (((position, predicted), velocity), &inverse_area) in
            particles.zip(self.fabric.inverse_areas())
        {
            if inverse_area == 0.0 {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let corrected = x - V3::load(token, predicted);
            let v: V3<L> = V3::load(token, velocity);
            (v + corrected * inverse_step).store(velocity);
        }
    }
}
