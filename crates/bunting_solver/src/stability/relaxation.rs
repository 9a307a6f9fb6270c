//! Under-relaxation of particles that oscillate at rest.
//!
//! The directions of a chain's links are frozen at the predicted positions, so that tension pulls a particle
//! across its links according to its predicted and not its final position. A particle that oscillates by X
//! from substep to substep is predicted at −9.2 X (at −3 X by backward Euler), and pulled to the other side
//! as soon as (β h)² ω² > 1.1 (1.3), with ω² = 4 T/(m l). Limp hanging cloth exceeds this near its supports
//! and along its borders, whatever the order of chains and the number of passes, and also without shear and
//! bending: neighbours oscillate against one another for ever, reversing in every substep.
//!
//! No other motion reverses in each of three substeps. Therefore, in a cloth that hardly moves, such a
//! particle makes only a fraction of each change of its velocity, its relaxation factor: half as much with
//! every further reversal, and slowly more again once the reversals have stopped (dynamic relaxation, as in
//! partitioned solvers of fluids and structures, which are unstable for the same reason: Küttler and Wall
//! 2008). A steady velocity is kept, and at rest nothing changes, so that rest states are exact.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::simd::lane::{Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Speed below which oscillation is ignored, m/s. Smaller: at 4,000 substeps a second rounding counts as
/// oscillation. Larger than twice this: cloth that oscillates never counts as at rest.
const UNSEEN: f32 = 5e-4;

/// Ratio of the factor to the one before in each substep in which a particle reverses.
const REDUCED: f32 = 0.5;

/// The factor of a particle that is not relaxed in a substep: a reversal makes it one.
pub(crate) const EXEMPT: f32 = 1.0 / REDUCED;

/// Ratio of the factor to the one before in each other substep. Smaller: cloth is slow to move again. Larger:
/// oscillation returns.
const RECOVERED: f32 = 1.0 + 1.0 / 32.0;

/// Least relaxation factor. Smaller: particles take longer to move again.
const LEAST: f32 = 1.0 / 32.0;

/// Fraction of the former velocity that a particle keeps in place of the rejected change. With 1 the delay
/// itself makes the border of a limp flag swing, at 8 Hz.
const KEPT: f32 = 0.9;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Relaxation factor of each particle of a cloth; empty if the cloth is not near rest, so that all are 1.
    pub fn relaxation_of(&self, cloth: usize) -> Vec<f32> {
        if !self.parameters.is_near_rest(Y::lanes(cloth)) {
            return Vec::new();
        }
        let located = (0..self.fabric.particle_count()).map(|at| self.layout.locate(at, cloth));
        located.map(|(pack, lane)| self.relaxation[pack].lanes()[lane]).collect()
    }

    /// Overwrites the relaxation factors of a cloth. The cloth is near rest unless `factors` is empty.
    pub fn set_relaxation(&mut self, cloth: usize, factors: &[f32]) {
        self.reset_relaxation(cloth);
        self.layout.write_numbers(factors, cloth, &mut self.relaxation);
        self.parameters.set_near_rest(Y::lanes(cloth), !factors.is_empty());
    }

    /// Sets the relaxation factors of a cloth to 1.
    pub fn reset_relaxation(&mut self, cloth: usize) {
        for factor in &mut self.relaxation {
            factor.lanes_mut()[Y::lanes(cloth)].fill(1.0);
        }
    }
}

/// Under-relaxation of a batch, in registers.
pub(crate) struct UnderRelaxation<L: Lane> {
    near_rest: L::Mask,
    /// Scalar product of two velocities below which the velocities are opposed, m²/s².
    opposed: L,
    one: L,
}

/// Factors of a pack of particles, in registers.
pub(crate) struct RelaxedPack<L: Lane> {
    /// Lanes whose factor is less than 1.
    relaxed: L::Mask,
    /// One minus the factor.
    missing: L,
}

impl<L: Lane> UnderRelaxation<L> {
    /// None if no cloth is near rest.
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Option<Self> {
        if !parameters.any_near_rest() {
            return None;
        }
        Some(Self {
            near_rest: L::splat(token, 0.0).lt(L::load(token, &parameters.near_rest)),
            opposed: L::splat(token, -UNSEEN * UNSEEN),
            one: L::splat(token, 1.0),
        })
    }

    /// Updates the factors of a pack, given the velocities of this substep and of the two before, m/s. None
    /// if the factor is 1 in all lanes.
    #[inline(always)]
    pub fn relax(
        &self,
        token: L::Token,
        velocity: V3<L>,
        (older, oldest): (&Pack3<L::Pack>, &Pack3<L::Pack>),
        factor: &mut L::Pack,
    ) -> Option<RelaxedPack<L>> {
        let older: V3<L> = V3::load(token, older);
        let turns = velocity.dot(older).lt(self.opposed) & self.near_rest;
        let last = L::load(token, factor);
        // Reversals are rare in any lane, so the oldest velocities are seldom loaded.
        if !(turns | last.lt(self.one)).any() {
            return None;
        }
        let turns = turns & older.dot(V3::load(token, oldest)).lt(self.opposed);
        let recovered = last * L::splat(token, RECOVERED);
        let recovered = self.one.or_where_not(self.one.lt(recovered), recovered);
        let reduced = (last * L::splat(token, REDUCED)).max(L::splat(token, LEAST));
        let next = reduced.or_where_not(turns, recovered).or_where_not(self.near_rest, last);
        next.store(factor);
        let relaxed = next.lt(self.one) & self.near_rest;
        Some(RelaxedPack { relaxed, missing: self.one - next })
    }
}

impl<L: Lane> RelaxedPack<L> {
    /// Value to subtract from `now`, a quantity whose value in the last substep was `before`; zero if the
    /// factor is 1.
    #[inline(always)]
    pub fn excess(&self, token: L::Token, now: V3<L>, before: V3<L>) -> V3<L> {
        let excess = (now - before * L::splat(token, KEPT)) * self.missing;
        excess.or_where_not(self.relaxed, V3::splat(token, 0.0))
    }
}
