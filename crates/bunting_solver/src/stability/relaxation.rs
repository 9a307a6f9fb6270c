//! Trembling at rest.
//!
//! The directions of a yarn's links are frozen where prediction has left them, so tension pulls on what
//! lies across it as on the predicted place, and not on the one where it comes to lie. A particle that goes
//! to and fro by X from substep to substep is predicted at −9.2 X (at −3 X by backward Euler), and pulled to
//! the other side as soon as (β h)² ω² > 1.1 (1.3), ω² = 4 T/(m l). Where cloth hangs limp that is exceeded
//! near its supports and along its borders, whatever the order of visits and the passes, and without bias and
//! bending, too: neighbours go to and fro against one another for ever, in every substep.
//!
//! Nothing but that does so in each of three substeps. So where a lane hardly moves, such a particle follows
//! what changes its velocity by half as much as before (dynamic relaxation, as of partitioned fluids and
//! structures, which fail for the same reason: Küttler and Wall 2008), and by more again once it has stopped.
//! What keeps its velocity keeps it, and at rest nothing changes, so that rest states are exact.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::simd::lane::{Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Speed below which going to and fro is let be, m/s: half of what counts as at rest, and more than rounding
/// makes of 4,000 substeps a second.
const UNSEEN: f32 = 5e-4;

/// What is left of a particle's share with each substep in which it goes to and fro.
const EASED: f32 = 0.5;

/// What its share grows by with each other substep. Slower: takes longer to wake. Faster: trembles again.
const WOKEN: f32 = 1.0 + 1.0 / 32.0;

/// Least share.
const LEAST_SHARE: f32 = 1.0 / 32.0;

/// Part that is kept of a velocity that a particle is not let change. With all of it what is late in
/// following swings by itself: the border of a limp flag, at 8 Hz.
const KEPT: f32 = 0.9;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// What part each particle of a cloth follows; empty where it does not creep, and all follow wholly.
    pub fn shares(&self, cloth: usize) -> Vec<f32> {
        if !self.parameters.creeps(C::lanes(cloth)) {
            return Vec::new();
        }
        let seats = (0..self.fabric.particle_count()).map(|at| self.seating.seat(at, cloth));
        seats.map(|(pack, lane)| self.share[pack].lanes()[lane]).collect()
    }

    /// Overwrites them, and with them whether the cloth creeps.
    pub fn set_shares(&mut self, cloth: usize, shares: &[f32]) {
        self.forget_tremor(cloth);
        self.seating.put(cloth, shares, &mut self.share);
        self.parameters.set_creeps(C::lanes(cloth), !shares.is_empty());
    }

    /// Lets a cloth's particles follow wholly.
    pub fn forget_tremor(&mut self, cloth: usize) {
        for share in &mut self.share {
            share.lanes_mut()[C::lanes(cloth)].fill(1.0);
        }
    }
}

/// What calms it, in registers.
pub(crate) struct Calm<L: Lane> {
    creeps: L::Mask,
    /// Scalar product of velocities that are opposed, m²/s².
    opposed: L,
    one: L,
}

/// How a particle lags behind.
pub(crate) struct Lag<L: Lane> {
    /// Where it does.
    lags: L::Mask,
    /// Part that it does not follow.
    missing: L,
}

impl<L: Lane> Calm<L> {
    /// None if no lane hardly moves.
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Option<Self> {
        if !parameters.creeps_any() {
            return None;
        }
        Some(Self {
            creeps: L::splat(token, 0.0).lt(L::load(token, &parameters.creeps)),
            opposed: L::splat(token, -UNSEEN * UNSEEN),
            one: L::splat(token, 1.0),
        })
    }

    /// How a particle lags, if it does in any lane, given its velocity, the two before, and its share.
    #[inline(always)]
    pub fn lag(
        &self,
        token: L::Token,
        velocity: V3<L>,
        (older, oldest): (&Pack3<L::Pack>, &Pack3<L::Pack>),
        share: &mut L::Pack,
    ) -> Option<Lag<L>> {
        let older: V3<L> = V3::load(token, older);
        let turns = velocity.dot(older).lt(self.opposed) & self.creeps;
        let last = L::load(token, share);
        // Seldom true of any lane, so that what is older need seldom be read.
        if !(turns | last.lt(self.one)).any() {
            return None;
        }
        let turns = turns & older.dot(V3::load(token, oldest)).lt(self.opposed);
        let woken = last * L::splat(token, WOKEN);
        let woken = self.one.or_where_not(self.one.lt(woken), woken);
        let eased = (last * L::splat(token, EASED)).max(L::splat(token, LEAST_SHARE));
        let part = eased.or_where_not(turns, woken).or_where_not(self.creeps, last);
        part.store(share);
        let lags = part.lt(self.one) & self.creeps;
        Some(Lag { lags, missing: self.one - part })
    }
}

impl<L: Lane> Lag<L> {
    /// What is to be taken off what has become of something, given what it was; nothing where it follows.
    #[inline(always)]
    pub fn excess(&self, token: L::Token, now: V3<L>, before: V3<L>) -> V3<L> {
        let excess = (now - before * L::splat(token, KEPT)) * self.missing;
        excess.or_where_not(self.lags, V3::splat(token, 0.0))
    }
}
