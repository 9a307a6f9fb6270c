//! Tethers: the distance of a particle from its nearest pin, and from its farthest, is at most the length of
//! the cloth between them.
//!
//! Tethers are one-sided and solved after the chains (Kim, Chentanez and Müller 2012, "Long range
//! attachments"). Those to the nearest pins hold the free corner of a flag that snaps like a whip, where the
//! frozen directions of chains overshoot. Those to the farthest pins hold a flag that is shaken until its lower
//! corner lies beneath its pole: at 10 Hz by half a metre the corner came to 1.92 m from the upper end of the
//! pole (33 × 33, two substeps; 1.46 with 64 substeps, 1.49 with tethers). Tethers are longer than at rest by the
//! strain that the loads may cause and by a slack, so that they do not hide the material's own strain.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, PackedTether, Particles, Positions};
use crate::constants::LEAST_LENGTH;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Projects every tether once.
    pub fn solve_tethers(&mut self) {
        let tethers = self.layout.tethers(&self.fabric);
        for (tethers, stretch) in tethers.into_iter().zip(&self.parameters.tether_stretch) {
            // Even for no tether, `particles` would copy the positions into row-major order.
            if tethers.is_empty() {
                continue;
            }
            let (masses, linked) = (&self.masses.inverse, self.layout.linked());
            P::run(Tethers {
                tethers,
                stretch,
                particles: self.positions.particles(Order::RowMajor, masses, linked),
            });
        }
    }
}

struct Tethers<'a, P: Pack, T, S> {
    tethers: &'a [T],
    /// Greatest length, in units of that at rest.
    stretch: &'a P,
    particles: S,
}

impl<P: Pack, T: PackedTether<P>, S: Particles<P>> Kernel<P> for Tethers<'_, P, T, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let stretch = L::load(token, self.stretch);
        for tether in self.tethers {
            let particle = tether.particle();
            let pin: V3<L> = tether.pin(token, &self.particles);
            let length = stretch * tether.length(token);
            let position: V3<L> = self.particles.position(token, particle);
            if let Some(position) = drawn_back(token, position, pin, length) {
                self.particles.set_position(token, particle, position);
            }
        }
    }
}

/// Moves positions to within a distance of pins. None if no lane is farther away.
#[inline(always)]
fn drawn_back<L: Lane>(token: L::Token, position: V3<L>, pin: V3<L>, length: L) -> Option<V3<L>> {
    let away = position - pin;
    let squared = away.dot(away);
    let too_far = (length * length).lt(squared);
    // A tether is seldom taut in any lane, so the root and the division are seldom computed.
    if !too_far.any() {
        return None;
    }
    let distance = squared.sqrt().max(L::splat(token, LEAST_LENGTH));
    Some((pin + away * (length / distance)).or_where_not(too_far, position))
}
