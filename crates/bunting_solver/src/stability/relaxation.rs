//! Under-relaxation of particles that oscillate at rest.
//!
//! The directions of a chain's links are frozen at the predicted positions, so that tension pulls a particle
//! across its links according to where it was predicted and not where it comes to lie. A particle that
//! oscillates by X from substep to substep is predicted at −9.2 X (at −3 X by backward Euler), and pulled to
//! the other side as soon as (β h)² ω² > 1.1 (1.3), ω² = 4 T/(m l). Where cloth hangs limp that is exceeded near
//! its supports and along its borders, whatever the order of chains and the number of passes, and also without
//! shear and bending: neighbours oscillate against one another for ever, turning round in every substep.
//!
//! No other motion turns round in each of three substeps. So where a cloth hardly moves, a particle that does
//! makes only a part of each change of its velocity, its relaxation factor: half as much with every further
//! turn, and slowly more again once the turns have stopped (dynamic relaxation, as in partitioned solvers of
//! fluids and structures, which are unstable for the same reason: Küttler and Wall 2008). A steady velocity is
//! kept, and at rest nothing changes, so that rest states are exact.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::simd::lane::{Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Speed below which oscillation is ignored, m/s. Smaller: at 4,000 substeps a second rounding counts as
/// oscillation. Larger than twice this: cloth that oscillates never counts as at rest.
const UNSEEN: f32 = 5e-4;

/// Change of the factor with each substep in which a particle turns round.
const REDUCED: f32 = 0.5;

/// Change of the factor with each other substep. Smaller: cloth is slow to move again. Larger: oscillation
/// returns.
const RECOVERED: f32 = 1.0 + 1.0 / 32.0;

/// Least factor.
const LEAST: f32 = 1.0 / 32.0;

/// Part of the former velocity that a particle keeps in place of a change that it does not make. With all of
/// it the delay itself makes the border of a limp flag swing, at 8 Hz.
const KEPT: f32 = 0.9;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Relaxation factor of each particle of a cloth; empty where the cloth is not near rest and all are 1.
    pub fn relaxation_of(&self, cloth: usize) -> Vec<f32> {
        if !self.parameters.is_near_rest(Y::lanes(cloth)) {
            return Vec::new();
        }
        let located = (0..self.fabric.particle_count()).map(|at| self.layout.locate(at, cloth));
        located.map(|(pack, lane)| self.relaxation[pack].lanes()[lane]).collect()
    }

    /// Overwrites the relaxation factors of a cloth, which is near rest unless there are none.
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
    /// Scalar product of two velocities below which they are opposed, m²/s².
    opposed: L,
    one: L,
}

/// Factors of a pack of particles, in registers.
pub(crate) struct RelaxedPack<L: Lane> {
    /// Lanes whose factor is less than 1.
    relaxed: L::Mask,
    /// One less the factor.
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
        // Seldom true of any lane, so that the oldest velocities are seldom loaded.
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
    /// What to subtract from the value `now` of a quantity whose value was `before`; zero where the factor
    /// is 1.
    #[inline(always)]
    pub fn excess(&self, token: L::Token, now: V3<L>, before: V3<L>) -> V3<L> {
        let excess = (now - before * L::splat(token, KEPT)) * self.missing;
        excess.or_where_not(self.relaxed, V3::splat(token, 0.0))
    }
}
