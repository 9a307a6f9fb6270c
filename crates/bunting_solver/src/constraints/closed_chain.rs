//! Chains whose ends are at one place: the columns of a grid around a closed mesh.
//!
//! Their last link, the *closing* one, pulls at the first particle as well, so that the system is tridiagonal but for two
//! corners. The other unknowns are eliminated with the closing one as a parameter: each is y + z × closing, where y solves
//! the open chain and z is the answer to a unit of the closing unknown. A chain that is solved open, and its ends
//! joined afterwards, opens at the seam instead of shrinking: all of its excess length gathers there.
//!
//! Across the lanes chains of different lengths end in the same row, and the shorter ones begin later, after rows without a link from
//! their first particle to itself. In such *leading* rows the lanes that have not begun keep the state of the elimination.

use crate::batch::layout::Particles;
use crate::constraints::chain::{Pass, SolveChains, first_of};
use crate::fabric::{ChainLink, ChainPair};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::V3;

/// Where the ends of `N` chains are.
#[derive(Clone, Copy)]
struct Seam<L, const N: usize> {
    /// The first and the last particle of each chain.
    ends: [[u32; N]; 2],
    /// The middle between their positions, m.
    middle: [V3<L>; N],
    /// Inverse mass of both together, 1/m².
    mass: [L; N],
    /// The closing link of each chain, m.
    closing: [V3<L>; N],
}

/// The last row of `N` chains before the closing links.
#[derive(Clone, Copy)]
struct LastRow<L, const N: usize> {
    /// The link, m.
    along: [V3<L>; N],
    /// Inverse mass at its end, 1/m².
    mass: [L; N],
    unknown: [L; N],
    /// Answer of the unknown to a unit of the closing one.
    by_closing: [L; N],
}

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves `N` closed chains side by side. Both ends of each go to one place.
    #[inline(always)]
    pub(super) fn solve_closed<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
    ) {
        let seam = self.seam::<L, N>(token, pair);
        let last_row = self.eliminate_to_closing::<L, N>(token, pair, pass, &seam);
        let first_unknowns = self.substitute_to_first::<L, N>(token, pair, &last_row);
        let closing =
            self.find_closing::<L, N>(token, pair, pass, (&seam, &last_row, &first_unknowns));
        self.substitute_closed::<L, N>(token, pair, pass, (&seam, &closing));
    }

    #[inline(always)]
    fn seam<L: Lane<Pack = P>, const N: usize>(
        &self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
    ) -> Seam<L, N> {
        let last = pair.links.len() - 1;
        let first = *first_of::<N>(&pair.particles[0]);
        let before_end = first_of::<N>(&pair.particles[last]);
        let end = *first_of::<N>(&pair.particles[last + 1]);
        let (zero3, half) = ([V3::<L>::splat(token, 0.0); N], L::splat(token, 0.5));
        let mut seam = Seam { ends: [first, end], middle: zero3, mass: [half; N], closing: zero3 };
        for at in 0..N {
            let start: V3<L> = self.particles.position(token, first[at]);
            let opposite: V3<L> = self.particles.position(token, end[at]);
            seam.middle[at] = start.plus_scaled(opposite - start, half);
            // Of two ends each has half of the mass there.
            let one_or_half = if first[at] == end[at] { L::splat(token, 1.0) } else { half };
            seam.mass[at] = one_or_half * self.particles.inverse_mass::<L>(token, first[at]);
            seam.closing[at] = seam.middle[at] - self.particles.position(token, before_end[at]);
        }
        seam
    }

    /// Eliminates all unknowns but the closing ones, from the first links to those before the last.
    #[inline(always)]
    fn eliminate_to_closing<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
        seam: &Seam<L, N>,
    ) -> LastRow<L, N> {
        let last = pair.links.len() - 1;
        let particles = &self.particles;
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (by_closing, _) = self.by_closing.as_chunks_mut::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks::<N>();
        // A link of zero length has no direction: its row becomes 0 = 0, and its unknown zero.
        let least = L::splat(token, f32::MIN_POSITIVE);
        let zero = [L::splat(token, 0.0); N];
        let (mut from, mut inverse) = (seam.middle, zero);
        // The closing link is the one before the first.
        let one = [L::splat(token, 1.0); N];
        let mut row =
            LastRow { along: seam.closing, mass: seam.mass, unknown: zero, by_closing: one };
        for link in 0..last {
            for at in 0..N {
                let ChainLink { class, rest_length } = pair.links[link][at];
                let compliance = L::load(token, &self.compliance[class as usize]);
                let target: L = pass.target(token, &targets[link][at], &rest_length);
                let next: V3<L> = particles.position(token, pair.particles[link + 1][at]);
                let next_mass: L = particles.inverse_mass(token, pair.particles[link + 1][at]);
                let along = next - from[at];
                let squared = along.dot(along);
                let length = squared.sqrt();
                let right = (-squared).plus_product(target, length);
                let coupling = row.mass[at] * row.along[at].dot(along);
                let multiplier = coupling * inverse[at];
                let diagonal = least.plus_product(row.mass[at] + next_mass + compliance, squared);
                let one = particles.one_if_linked::<L>(token, class);
                let stored = &mut rows[link][at];
                let one = match pass {
                    Pass::Overlong => one * L::load(token, &stored.unknown),
                    _ => one,
                };
                inverse[at] = one / diagonal.minus_product(coupling, multiplier);
                row.unknown[at] = right.plus_product(coupling, row.unknown[at]) * inverse[at];
                let of_closing = coupling * row.by_closing[at];
                // The closing link is the one behind the last but one, too.
                let of_closing = match link + 1 == last {
                    true => of_closing.plus_product(next_mass, along.dot(seam.closing[at])),
                    false => of_closing,
                };
                let by = of_closing * inverse[at];
                along.store(&mut stored.along);
                multiplier.store(&mut stored.multiplier);
                row.unknown[at].store(&mut stored.unknown);
                (compliance * length).store(&mut stored.target_change);
                by.store(&mut by_closing[link][at]);
                (from[at], row.mass[at]) = (next, next_mass);
                (row.along[at], row.by_closing[at]) = if link < pair.leading {
                    let begun = has_begun::<L, S, P>(token, particles, &pair.links[link][at]);
                    let along = along.or_where_not(begun, row.along[at]);
                    (along, by.or_where_not(begun, row.by_closing[at]))
                } else {
                    (along, by)
                };
            }
        }
        row
    }

    /// Substitutes back to the first links: the unknowns of the open chains, and their answers to the closing ones. Returns
    /// both for the first links.
    #[inline(always)]
    fn substitute_to_first<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        last_row: &LastRow<L, N>,
    ) -> [[L; N]; 2] {
        let last = pair.links.len() - 1;
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (by_closing, _) = self.by_closing.as_chunks_mut::<N>();
        let LastRow { mut unknown, by_closing: mut by, .. } = *last_row;
        let mut multiplier = unknown;
        for at in 0..N {
            multiplier[at] = L::load(token, &rows[last - 1][at].multiplier);
        }
        for link in (0..last - 1).rev() {
            for at in 0..N {
                let row = &mut rows[link][at];
                let own = L::load(token, &row.unknown);
                let found = own.plus_product(multiplier[at], unknown[at]);
                let own_by = L::load(token, &by_closing[link][at]);
                let found_by = own_by.plus_product(multiplier[at], by[at]);
                multiplier[at] = L::load(token, &row.multiplier);
                found.store(&mut row.unknown);
                found_by.store(&mut by_closing[link][at]);
                (unknown[at], by[at]) = if link < pair.leading {
                    let of_row = &pair.links[link][at];
                    let begun = has_begun::<L, S, P>(token, &self.particles, of_row);
                    let unknown = found.or_where_not(begun, unknown[at]);
                    (unknown, found_by.or_where_not(begun, by[at]))
                } else {
                    (found, found_by)
                };
            }
        }
        [unknown, by]
    }

    /// Finds the unknowns of the closing links.
    #[inline(always)]
    fn find_closing<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
        (seam, last_row, [unknown, by]): (&Seam<L, N>, &LastRow<L, N>, &[[L; N]; 2]),
    ) -> [(L, L::Mask); N] {
        let last = pair.links.len() - 1;
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (by_closing, _) = self.by_closing.as_chunks_mut::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks::<N>();
        let (zero, least) = (L::splat(token, 0.0), L::splat(token, f32::MIN_POSITIVE));
        let mut found = [(zero, zero.lt(zero)); N];
        for at in 0..N {
            let ChainLink { class, rest_length } = pair.links[last][at];
            let compliance = L::load(token, &self.compliance[class as usize]);
            let target: L = pass.target(token, &targets[last][at], &rest_length);
            let closing = seam.closing[at];
            let squared = closing.dot(closing);
            let length = squared.sqrt();
            let to_last = last_row.mass[at] * last_row.along[at].dot(closing);
            let mut first = V3::load(token, &rows[pair.leading][at].along);
            for link in (0..pair.leading).rev() {
                let of_row = &pair.links[link][at];
                let begun = has_begun::<L, S, P>(token, &self.particles, of_row);
                first = V3::load(token, &rows[link][at].along).or_where_not(begun, first);
            }
            let to_first = seam.mass[at] * closing.dot(first);
            let right = (-squared)
                .plus_product(target, length)
                .plus_product(to_last, last_row.unknown[at])
                .plus_product(to_first, unknown[at]);
            let diagonal = least
                .plus_product(last_row.mass[at] + seam.mass[at] + compliance, squared)
                .minus_product(to_last, last_row.by_closing[at])
                .minus_product(to_first, by[at]);
            let one = self.particles.one_if_linked::<L>(token, class);
            let row = &mut rows[last][at];
            let one = if pass == Pass::Overlong { one * L::load(token, &row.unknown) } else { one };
            let of_closing = one * right / diagonal;
            closing.store(&mut row.along);
            of_closing.store(&mut row.unknown);
            (compliance * length).store(&mut row.target_change);
            zero.store(&mut by_closing[last][at]);
            found[at] = (of_closing, zero.lt(one));
        }
        found
    }

    /// Moves each particle by the tensions of its two links at once, given the closing unknowns, and whether their chains are
    /// solved.
    #[inline(always)]
    fn substitute_closed<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
        (seam, closing): (&Seam<L, N>, &[(L, L::Mask); N]),
    ) {
        let last = pair.links.len() - 1;
        let particles = &mut self.particles;
        let (rows, _) = self.rows.as_chunks::<N>();
        let (by_closing, _) = self.by_closing.as_chunks::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks_mut::<N>();
        let mut next_tension = [V3::<L>::splat(token, 0.0); N];
        let mut closing_tension = next_tension;
        for link in (0..=last).rev() {
            for at in 0..N {
                let row = &rows[link][at];
                let (of_closing, _) = closing[at];
                let unknown = L::load(token, &row.unknown)
                    .plus_product(L::load(token, &by_closing[link][at]), of_closing);
                let rest_length = &pair.links[link][at].rest_length;
                let target: L = pass.target(token, &targets[link][at], rest_length);
                let change = L::load(token, &row.target_change);
                target.minus_product(change, unknown).store(&mut targets[link][at]);
                let tension = V3::load(token, &row.along) * unknown;
                if link == last {
                    (closing_tension[at], next_tension[at]) = (tension, tension);
                    continue;
                }
                // A pull at a first particle is lost: its position is overwritten below.
                let pull = tension - next_tension[at];
                next_tension[at] = if link < pair.leading {
                    let begun = has_begun::<L, S, P>(token, particles, &pair.links[link][at]);
                    tension.or_where_not(begun, next_tension[at])
                } else {
                    tension
                };
                let particle = pair.particles[link + 1][at];
                let inverse_mass = particles.inverse_mass(token, particle);
                let position = particles.position(token, particle);
                particles.correct(token, particle, position, (pull, inverse_mass));
            }
        }
        for at in 0..N {
            let pull = closing_tension[at] - next_tension[at];
            let moved = seam.middle[at].plus_scaled(pull, seam.mass[at]);
            let (_, is_solved) = closing[at];
            // Lanes without a chain hold particles of other rows, which another chain may have moved since.
            for end in seam.ends {
                let place = particles.position(token, end[at]);
                particles.set_position(token, end[at], moved.or_where_not(is_solved, place));
            }
        }
    }
}

/// The lanes of a leading row whose chain has begun.
#[inline(always)]
fn has_begun<L: Lane<Pack = P>, S: Particles<P>, P: Pack>(
    token: L::Token,
    particles: &S,
    link: &ChainLink<S::Constant>,
) -> L::Mask {
    L::splat(token, 0.0).lt(particles.one_if_linked(token, link.class))
}
