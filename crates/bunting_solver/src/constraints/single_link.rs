//! Chains of a single link: there is nothing to eliminate, and rows are not stored.

use core::ops::Range;

use crate::batch::layout::Particles;
use crate::constraints::chain::{Pass, SolveChains};
use crate::fabric::{CHAINS_PER_PAIR, ChainLink};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves `N` chains of a single link.
    #[inline(always)]
    pub(super) fn solve_links<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        ends: [&[u32; N]; 2],
        links: &[ChainLink<S::Constant>; CHAINS_PER_PAIR],
        targets: &Range<usize>,
        pass: Pass,
    ) {
        let particles = &mut self.particles;
        let targets = &mut self.target[targets.clone()];
        // A link of zero length has no direction, and its unknown is zero.
        let least = L::splat(token, f32::MIN_POSITIVE);
        for at in 0..N {
            let ChainLink { class, rest_length } = links[at];
            let [a, b] = [ends[0][at], ends[1][at]];
            let compliance = L::load(token, &self.compliance[class as usize]);
            let target: L = pass.target(token, &targets[at], &rest_length);
            let from: V3<L> = particles.position(token, a);
            let to: V3<L> = particles.position(token, b);
            let mass_a: L = particles.inverse_mass(token, a);
            let mass_b: L = particles.inverse_mass(token, b);
            let along = to - from;
            let squared = along.dot(along);
            let length = squared.sqrt();
            let right = (-squared).plus_product(target, length);
            let one = particles.one_if_linked::<L>(token, class);
            let one = match pass {
                Pass::Overlong => one * L::load(token, &self.rows[at].unknown),
                _ => one,
            };
            let unknown = right * (one / least.plus_product(mass_a + mass_b + compliance, squared));
            if pass.stores_targets() {
                target.minus_product(compliance * length, unknown).store(&mut targets[at]);
            }
            let tension = along * unknown;
            particles.correct(token, a, from, (tension, -mass_a));
            // Lanes without a link may hold particles of the first ends.
            let to = particles.position(token, b);
            particles.correct(token, b, to, (tension, mass_b));
        }
    }
}
