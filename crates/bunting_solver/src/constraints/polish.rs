//! Polish: one sweep over warp and weft after the yarns, link by link.
//!
//! Where a flag cracks like a whip, the frozen directions of a yarn overshoot at its free end; a
//! sweep takes off what single links are then too long by. The constraint and its targets are
//! those of the yarns.

use crate::fabric::PolishLink;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Sweeps over warp and weft once, yarn by yarn.
    pub fn polish(&mut self) {
        P::run(Polish {
            links: &self.fabric.strands().polish,
            weights: &self.weights,
            compliance: &self.parameters.link_compliance,
            target: &mut self.link_target,
            position: &mut self.position,
        });
    }
}

struct Polish<'a, P: Pack> {
    links: &'a [PolishLink],
    weights: &'a [f32],
    compliance: &'a [P],
    target: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Polish<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let least = L::splat(token, f32::MIN_POSITIVE);
        let one = L::splat(token, 1.0);
        for link in self.links {
            let target = &mut self.target[link.target as usize];
            let (a, b) = (link.particles[0] as usize, link.particles[1] as usize);
            let (wa, wb) = (L::splat(token, self.weights[a]), L::splat(token, self.weights[b]));
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = V3::load(token, &self.position[a]);
            let to: V3<L> = V3::load(token, &self.position[b]);
            let along = to - from;
            let squared = along.dot(along);
            let length = squared.sqrt();
            let held = L::load(token, target);
            let lack = (-squared).plus_product(held, length);
            // Multiplied, not divided by: the division need not wait for the root.
            let inverse = one / least.plus_product(wa + wb + compliance, squared);
            let change = lack * inverse;
            held.minus_product(compliance * length, change).store(target);
            let pull = along * change;
            from.minus_scaled(pull, wa).store(&mut self.position[a]);
            to.plus_scaled(pull, wb).store(&mut self.position[b]);
        }
    }
}
