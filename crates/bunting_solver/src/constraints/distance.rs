//! Distance: C = |x₂ − x₁| − l (thesis, eq. 4.15 to 4.18), along warp, weft and bias.

use crate::constants::LEAST_LENGTH;
use crate::fabric::Link;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Projects every link once.
    pub fn solve_distance(&mut self, accumulate: bool) {
        let solve = Distance {
            links: self.fabric.links(),
            weights: &self.weights,
            compliance: &self.parameters.link_compliance,
            multiplier: &mut self.link_multiplier,
            position: &mut self.position,
        };
        if accumulate {
            P::run(Accumulating(solve));
        } else {
            P::run(solve);
        }
    }
}

struct Distance<'a, P: Pack> {
    links: &'a [Link],
    weights: &'a [f32],
    compliance: &'a [P],
    multiplier: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Distance<'_, P> {
    #[inline(always)]
    fn solve<L: Lane<Pack = P>, const ACCUMULATE: bool>(self, token: L::Token) {
        let weights = self.weights;
        let least = L::splat(token, LEAST_LENGTH);
        for (link, multiplier) in self.links.iter().zip(self.multiplier) {
            let [a, b] = link.particles.map(|particle| particle as usize);
            let (wa, wb) = (L::splat(token, weights[a]), L::splat(token, weights[b]));
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = V3::load(token, &self.position[a]);
            let to: V3<L> = V3::load(token, &self.position[b]);
            let along = to - from;
            let length = along.dot(along).sqrt().max(least);
            let mut excess = length - L::splat(token, link.rest_length);
            if ACCUMULATE {
                excess = excess + compliance * L::load(token, multiplier);
            }
            let stiffness = wa + wb + compliance;
            // −Δλ/|d| with one division: the gradient's length goes into the denominator.
            let pull = excess / (stiffness * length);
            if ACCUMULATE {
                (L::load(token, multiplier) - pull * length).store(multiplier);
            }
            (from + along * (pull * wa)).store(&mut self.position[a]);
            (to - along * (pull * wb)).store(&mut self.position[b]);
        }
    }
}

impl<P: Pack> Kernel<P> for Distance<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.solve::<L, false>(token);
    }
}

/// The same with a multiplier that is kept from pass to pass.
struct Accumulating<K>(K);

impl<P: Pack> Kernel<P> for Accumulating<Distance<'_, P>> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.0.solve::<L, true>(token);
    }
}
