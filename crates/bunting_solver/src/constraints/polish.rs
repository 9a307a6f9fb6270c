//! Polish: one sweep over warp and weft after the yarns, link by link.
//!
//! Where a flag cracks like a whip, the frozen directions of a yarn overshoot at its free end; a
//! sweep takes off what single links are then too long by. The constraint and its multipliers are
//! those of the yarns.

use crate::fabric::Link;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Sweeps over warp and weft once, colour by colour.
    pub fn polish(&mut self) {
        P::run(Polish {
            links: &self.fabric.links()[..self.fabric.stretch_link_count()],
            weights: &self.weights,
            compliance: &self.parameters.link_compliance,
            multiplier: &mut self.link_multiplier,
            position: &mut self.position,
        });
    }
}

struct Polish<'a, P: Pack> {
    links: &'a [Link],
    weights: &'a [f32],
    compliance: &'a [P],
    multiplier: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Polish<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let least = L::splat(token, f32::MIN_POSITIVE);
        for (link, multiplier) in self.links.iter().zip(self.multiplier) {
            let [a, b] = link.particles.map(|particle| particle as usize);
            let (wa, wb) = (L::splat(token, self.weights[a]), L::splat(token, self.weights[b]));
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = V3::load(token, &self.position[a]);
            let to: V3<L> = V3::load(token, &self.position[b]);
            let along = to - from;
            let squared = along.dot(along);
            let held = L::load(token, multiplier);
            let length = squared.sqrt();
            let rest_length = L::splat(token, link.rest_length);
            let excess = squared - rest_length * length + compliance * held * length;
            let change = -excess / ((wa + wb + compliance) * squared + least);
            (held + change * length).store(multiplier);
            let pull = along * change;
            (from - pull * wa).store(&mut self.position[a]);
            (to + pull * wb).store(&mut self.position[b]);
        }
    }
}
