//! Chains whose ends are at one place: the columns of a grid around a closed mesh.
//!
//! Their last link, the *closing* one, pulls at the first particle as well, so that the system is tridiagonal but for two
//! corners. The other unknowns are eliminated with the closing one as a parameter: each is y + z × closing, where y solves
//! the open chain and z is the answer to a unit of the closing unknown. A chain that is solved open, and its ends
//! joined afterwards, opens at the seam instead of shrinking: all of its excess length gathers there.

use crate::batch::layout::Particles;
use crate::constraints::chain::{Pass, SolveChains, first_of};
use crate::fabric::{ChainLink, ChainPair};
use crate::simd::constant::Constant;
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves `N` closed chains side by side. Both ends of each go to one place.
    #[inline(always)]
    pub(super) fn solve_closed<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
    ) {
        let is_warm = pass.is_warm();
        let last = pair.links.len() - 1;
        let (zero, half) = (L::splat(token, 0.0), L::splat(token, 0.5));
        // A link of zero length has no direction: its row becomes 0 = 0, and its unknown zero.
        let least = L::splat(token, f32::MIN_POSITIVE);
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (by_closing, _) = self.by_closing.as_chunks_mut::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks_mut::<N>();
        let particles = &mut self.particles;
        let first = first_of::<N>(&pair.particles[0]);
        let before_end = first_of::<N>(&pair.particles[last]);
        let end = first_of::<N>(&pair.particles[last + 1]);
        for at in 0..N {
            let start: V3<L> = particles.position(token, first[at]);
            let opposite: V3<L> = particles.position(token, end[at]);
            let seam = start.plus_scaled(opposite - start, half);
            // Of two ends each has half of the mass there.
            let one_or_half = if first[at] == end[at] { L::splat(token, 1.0) } else { half };
            let seam_mass = one_or_half * particles.inverse_mass::<L>(token, first[at]);
            let closing = seam - particles.position(token, before_end[at]);

            // Forwards over all links but the closing one.
            let (mut from, mut mass, mut before) = (seam, seam_mass, closing);
            let (mut inverse, mut unknown, mut by) = (zero, zero, zero);
            for link in 0..last {
                let ChainLink { class, rest_length } = pair.links[link][at];
                let compliance = L::load(token, &self.compliance[class as usize]);
                let target = match is_warm {
                    true => L::load(token, &targets[link][at]),
                    false => rest_length.load(token),
                };
                let next: V3<L> = particles.position(token, pair.particles[link + 1][at]);
                let next_mass: L = particles.inverse_mass(token, pair.particles[link + 1][at]);
                let along = next - from;
                let squared = along.dot(along);
                let length = squared.sqrt();
                let right = (-squared).plus_product(target, length);
                let coupling = mass * before.dot(along);
                let multiplier = coupling * inverse;
                let diagonal = least.plus_product(mass + next_mass + compliance, squared);
                let one = particles.one_if_linked::<L>(token, class);
                let row = &mut rows[link][at];
                let one =
                    if pass == Pass::Overlong { one * L::load(token, &row.unknown) } else { one };
                inverse = one / diagonal.minus_product(coupling, multiplier);
                unknown = right.plus_product(coupling, unknown) * inverse;
                // The closing link is the one before the first, and the one behind the last but one.
                let of_closing = if link == 0 { coupling } else { coupling * by };
                let of_closing = match link + 1 == last {
                    true => of_closing.plus_product(next_mass, along.dot(closing)),
                    false => of_closing,
                };
                by = of_closing * inverse;
                along.store(&mut row.along);
                multiplier.store(&mut row.multiplier);
                unknown.store(&mut row.unknown);
                (compliance * length).store(&mut row.target_change);
                by.store(&mut by_closing[link][at]);
                (from, mass, before) = (next, next_mass, along);
            }

            // Backwards: the unknowns of the open chain, and their answers to the closing one.
            let (of_last, by_last) = (unknown, by);
            let mut multiplier = L::load(token, &rows[last - 1][at].multiplier);
            for link in (0..last - 1).rev() {
                let row = &mut rows[link][at];
                unknown = L::load(token, &row.unknown).plus_product(multiplier, unknown);
                by = L::load(token, &by_closing[link][at]).plus_product(multiplier, by);
                multiplier = L::load(token, &row.multiplier);
                unknown.store(&mut row.unknown);
                by.store(&mut by_closing[link][at]);
            }

            // The closing link.
            let ChainLink { class, rest_length } = pair.links[last][at];
            let compliance = L::load(token, &self.compliance[class as usize]);
            let target = match is_warm {
                true => L::load(token, &targets[last][at]),
                false => rest_length.load(token),
            };
            let squared = closing.dot(closing);
            let length = squared.sqrt();
            let to_last = mass * before.dot(closing);
            let to_first = seam_mass * closing.dot(V3::load(token, &rows[0][at].along));
            let right = (-squared)
                .plus_product(target, length)
                .plus_product(to_last, of_last)
                .plus_product(to_first, unknown);
            let diagonal = least
                .plus_product(mass + seam_mass + compliance, squared)
                .minus_product(to_last, by_last)
                .minus_product(to_first, by);
            let one = particles.one_if_linked::<L>(token, class);
            let row = &mut rows[last][at];
            let one = if pass == Pass::Overlong { one * L::load(token, &row.unknown) } else { one };
            let is_solved = zero.lt(one);
            let of_closing = one * right / diagonal;
            closing.store(&mut row.along);
            of_closing.store(&mut row.unknown);
            (compliance * length).store(&mut row.target_change);
            zero.store(&mut by_closing[last][at]);

            // Each particle is moved by the tensions of its two links at once.
            let mut next_tension = V3::<L>::splat(token, 0.0);
            let mut closing_tension = next_tension;
            for link in (0..=last).rev() {
                let row = &rows[link][at];
                let unknown = L::load(token, &row.unknown)
                    .plus_product(L::load(token, &by_closing[link][at]), of_closing);
                let target = match is_warm {
                    true => L::load(token, &targets[link][at]),
                    false => pair.links[link][at].rest_length.load(token),
                };
                let change = L::load(token, &row.target_change);
                target.minus_product(change, unknown).store(&mut targets[link][at]);
                let tension = V3::load(token, &row.along) * unknown;
                if link == last {
                    closing_tension = tension;
                } else {
                    let particle = pair.particles[link + 1][at];
                    let inverse_mass = particles.inverse_mass(token, particle);
                    let position = particles.position(token, particle);
                    let pull = tension - next_tension;
                    particles.correct(token, particle, position, (pull, inverse_mass));
                }
                next_tension = tension;
            }
            let moved = seam.plus_scaled(closing_tension - next_tension, seam_mass);
            // Lanes without a chain hold particles of other rows.
            particles.set_position(token, first[at], moved.or_where_not(is_solved, start));
            particles.set_position(token, end[at], moved.or_where_not(is_solved, opposite));
        }
    }
}
