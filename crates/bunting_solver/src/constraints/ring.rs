//! Rings: chains around a closed grid, whose last particle is the first one.
//!
//! A ring that is solved as an open chain gives way at its ends, as nothing pulls from beyond them: there it carries no
//! tension around a funnel. Its system is tridiagonal but for its two corners, which couple the first and the last link. It is
//! solved as the sum of a tridiagonal one and a product of two vectors (Sherman and Morrison 1950): the elimination
//! carries a second right side along.

use crate::batch::layout::Particles;
use crate::constraints::chain::{Pass, SolveChains};
use crate::constraints::tridiagonal::TridiagonalRow;
use crate::fabric::{CHAINS_PER_PAIR, ChainPair};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

/// The chains of one colour, of which some are rings.
pub(super) struct SolveRings<'a, P: Pack, S: Particles<P>> {
    pub chains: SolveChains<'a, P, S>,
    /// Whether the chains of each pair are rings.
    pub are_rings: &'a [bool],
}

impl<P: Pack, S: Particles<P>> Kernel<P> for SolveRings<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let (pairs, pass) = (self.chains.pairs, self.chains.pass);
        for (pair, &is_ring) in pairs.iter().zip(self.are_rings) {
            match (is_ring, pair.count) {
                (true, count) => {
                    for at in 0..count {
                        self.chains.solve_ring::<L>(token, pair, at, pass);
                    }
                }
                (false, CHAINS_PER_PAIR) => {
                    self.chains.solve::<L, CHAINS_PER_PAIR>(token, pair, pass);
                }
                (false, _) => self.chains.solve::<L, 1>(token, pair, pass),
            }
        }
    }
}

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves one ring of a pair.
    #[inline(always)]
    fn solve_ring<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        at: usize,
        pass: Pass,
    ) {
        let zero = L::splat(token, 0.0);
        let half = L::splat(token, 0.5);
        let least = L::splat(token, f32::MIN_POSITIVE);
        let count = pair.links.len();
        let (first, last) = (pair.particles[0][at], pair.particles[count][at]);
        let first_target = pair.targets.start + at;
        let start = {
            let (one, other): (V3<L>, V3<L>) =
                (self.particles.position(token, first), self.particles.position(token, last));
            one.plus_scaled(other - one, half)
        };
        // Both have half of the mass of the particle that they are.
        let joint_mass = half * self.particles.inverse_mass::<L>(token, first);

        let (mut end, mut end_mass) = (start, joint_mass);
        let (mut before, mut first_along) =
            (V3::<L>::splat(token, 0.0), V3::<L>::splat(token, 0.0));
        let (mut inverse, mut unknown, mut second) = (zero, zero, zero);
        let (mut first_diagonal, mut corner) = (zero, zero);
        for row in 0..count {
            let link = &pair.links[row][at];
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let target = if pass == Pass::First {
                link.rest_length.load(token)
            } else {
                L::load(token, &self.target[first_target + row * pair.count])
            };
            let is_last = row + 1 == count;
            let particle = pair.particles[row + 1][at];
            let next: V3<L> =
                if is_last { start } else { self.particles.position(token, particle) };
            let next_mass =
                if is_last { joint_mass } else { self.particles.inverse_mass(token, particle) };
            let along = next - end;
            let squared = along.dot(along);
            let length = squared.sqrt();
            let right = (zero - squared).plus_product(target, length);
            let coupling = end_mass * before.dot(along);
            let multiplier = coupling * inverse;
            let mut diagonal = least.plus_product(end_mass + next_mass + compliance, squared);
            let mut second_right = zero;
            if row == 0 {
                (first_diagonal, first_along) = (diagonal, along);
                second_right = zero - diagonal;
                diagonal = diagonal + diagonal;
            }
            if is_last {
                corner = zero - joint_mass * along.dot(first_along);
                second_right = corner;
                diagonal = diagonal.plus_product(corner, corner / first_diagonal);
            }
            inverse = L::splat(token, 1.0) / diagonal.minus_product(coupling, multiplier);
            unknown = right.plus_product(coupling, unknown) * inverse;
            second = second_right.plus_product(coupling, second) * inverse;
            let [of_unknown, of_second] = self.rows_of(row);
            along.store(&mut of_unknown.along);
            multiplier.store(&mut of_unknown.multiplier);
            unknown.store(&mut of_unknown.unknown);
            (compliance * length).store(&mut of_unknown.target_change);
            second.store(&mut of_second.unknown);
            (before, end, end_mass) = (along, next, next_mass);
        }
        // Solutions for both right sides.
        let (mut multiplier, mut unknown, mut second) = (zero, zero, zero);
        let (mut of_last, mut second_of_last) = (zero, zero);
        for row in (0..count).rev() {
            let [of_unknown, of_second] = self.rows_of(row);
            unknown = L::load(token, &of_unknown.unknown).plus_product(multiplier, unknown);
            second = L::load(token, &of_second.unknown).plus_product(multiplier, second);
            multiplier = L::load(token, &of_unknown.multiplier);
            unknown.store(&mut of_unknown.unknown);
            second.store(&mut of_second.unknown);
            if row + 1 == count {
                (of_last, second_of_last) = (unknown, second);
            }
        }
        let by_corner = zero - corner / first_diagonal;
        let along_vector = unknown.plus_product(by_corner, of_last);
        let second_along = second.plus_product(by_corner, second_of_last);
        let part = along_vector / (L::splat(token, 1.0) + second_along);
        let mut next_tension = V3::<L>::splat(token, 0.0);
        let mut last_tension = next_tension;
        for row in (0..count).rev() {
            let [of_unknown, of_second] = self.rows_of(row);
            let unknown = L::load(token, &of_unknown.unknown)
                .minus_product(part, L::load(token, &of_second.unknown));
            let tension = V3::load(token, &of_unknown.along) * unknown;
            let change = L::load(token, &of_unknown.target_change) * unknown;
            let target = &mut self.target[first_target + row * pair.count];
            let before = if pass == Pass::First {
                pair.links[row][at].rest_length.load(token)
            } else {
                L::load(token, target)
            };
            (before - change).store(target);
            if row + 1 == count {
                last_tension = tension;
            } else {
                let particle = pair.particles[row + 1][at];
                let inverse_mass = self.particles.inverse_mass(token, particle);
                let position = self.particles.position(token, particle);
                self.particles.correct(
                    token,
                    particle,
                    position,
                    (tension - next_tension, inverse_mass),
                );
            }
            next_tension = tension;
        }
        for particle in [first, last] {
            let pull = (last_tension - next_tension, joint_mass);
            self.particles.correct(token, particle, start, pull);
        }
    }

    /// The rows of both right sides of a link.
    #[inline(always)]
    fn rows_of(&mut self, row: usize) -> &mut [TridiagonalRow<P>; 2] {
        let (rows, _) = self.rows.as_chunks_mut::<2>();
        &mut rows[row]
    }
}
