//! A Gauss–Seidel sweep over the links of warp and weft after the chains.
//!
//! Where a flag snaps like a whip, a chain overshoots at its free end, as its directions are frozen. A sweep,
//! link by link, corrects single lengths. It has the constraint and the targets of the chains.
//!
//! The diagonals of a net, each of which is a chain by itself, are solved by the same sweep in each pass.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::constraints::direction::sweep_order;
use crate::fabric::{CHAINS_PER_PAIR, ChainPair, LinkFamily, SweepLink};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves each link of warp and weft once, of the last colour first if `reverses`.
    pub fn sweep_links(&mut self, reverses: bool) {
        for colour in sweep_order(self.colour_count(), reverses) {
            let family = self.layout.chains(&self.fabric).colours[colour].family;
            if family != LinkFamily::Diagonal {
                self.sweep_colour(colour);
            }
        }
    }

    /// Solves each link of a colour once.
    pub(super) fn sweep_colour(&mut self, index: usize) {
        let chains = self.layout.chains(&self.fabric);
        let colour = &chains.colours[index];
        let order = self.layout.order_of_chains(index);
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        let links = &chains.sweep_links[colour.sweep_links.clone()];
        let compliance = &self.layout.factors().link_compliance;
        let target = &mut self.link_target;
        let pairs = &chains.pairs[colour.pairs.clone()];
        // A ring that begins later than others in its pack has its first particle in two rows.
        let has_leading = pairs.iter().any(|pair| pair.leading > 0);
        if colour.family == LinkFamily::Diagonal || has_leading {
            let particles = self.positions.particles(order, masses, linked);
            P::run(Sweep { lines: &[], links, compliance, target, particles });
        } else {
            let particles = self.positions.lines(order, masses, linked);
            P::run(Sweep { lines: pairs, links, compliance, target, particles });
        }
    }
}

struct Sweep<'a, P: Pack, S: Particles<P>> {
    /// The lines of the links, if particles are brought.
    lines: &'a [ChainPair<S::Constant>],
    /// The links of one colour.
    links: &'a [SweepLink],
    compliance: &'a [P],
    target: &'a mut [P],
    particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for Sweep<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for pair in self.lines {
            self.particles.bring::<L, CHAINS_PER_PAIR>(token, &pair.particles, pair.count);
        }
        let least = L::splat(token, f32::MIN_POSITIVE);
        for link in self.links {
            let stored = &mut self.target[link.target as usize];
            let [a, b] = link.particles;
            let mass_a: L = self.particles.inverse_mass(token, a);
            let mass_b: L = self.particles.inverse_mass(token, b);
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = self.particles.position(token, a);
            let to: V3<L> = self.particles.position(token, b);
            let along = to - from;
            let squared = along.dot(along);
            let length = squared.sqrt();
            let target = L::load(token, stored);
            let right = (-squared).plus_product(target, length);
            // Multiplying by the inverse lets the division start before the root is known.
            let one = self.particles.one_if_linked::<L>(token, link.class);
            let inverse = one / least.plus_product(mass_a + mass_b + compliance, squared);
            let unknown = right * inverse;
            target.minus_product(compliance * length, unknown).store(stored);
            let tension = along * unknown;
            self.particles.set_position(token, a, from.minus_scaled(tension, mass_a));
            self.particles.set_position(token, b, to.plus_scaled(tension, mass_b));
        }
        for pair in self.lines {
            self.particles.put_back::<L, CHAINS_PER_PAIR>(token, &pair.particles, pair.count);
        }
    }
}
