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

use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::places::Constant;
use crate::vector::{Pack3, V3};

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
    /// Calms what goes to and fro in each substep, in lanes that hardly move.
    pub fn calm_tremor(&mut self) {
        if !self.parameters.creeps_any() {
            return;
        }
        P::run(CalmTremor {
            inverse_areas: &self.packs.inverse_areas,
            creeps: &self.parameters.creeps,
            past: [&self.older_velocity, &self.oldest_velocity],
            older_displacement: &self.older_displacement,
            share: &mut self.share,
            position: &mut self.position,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
        });
    }

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

struct CalmTremor<'a, P: Pack, C> {
    inverse_areas: &'a [C],
    creeps: &'a P,
    /// Velocities at the start of the substep and of the one before.
    past: [&'a [Pack3<P>]; 2],
    older_displacement: &'a [Pack3<P>],
    share: &'a mut [P],
    position: &'a mut [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for CalmTremor<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let one = L::splat(token, 1.0);
        let creeps = L::splat(token, 0.0).lt(L::load(token, self.creeps));
        let opposed = L::splat(token, -UNSEEN * UNSEEN);
        let kept = L::splat(token, KEPT);
        let [older_velocity, oldest_velocity] = self.past;
        let speeds = self.velocity.iter_mut().zip(older_velocity).zip(oldest_velocity);
        let changes = self.displacement.iter_mut().zip(self.older_displacement);
        let places = self.position.iter_mut().zip(changes);
        for (
            (((velocity, older), oldest), share),
            ((position, (displacement, older_displacement)), inverse_area),
        ) in speeds.zip(self.share).zip(places.zip(self.inverse_areas))
        {
            if inverse_area.is_zero() {
                continue;
            }
            let v: V3<L> = V3::load(token, velocity);
            let older: V3<L> = V3::load(token, older);
            let turns =
                v.dot(older).lt(opposed) & older.dot(V3::load(token, oldest)).lt(opposed) & creeps;
            let last = L::load(token, share);
            if !(turns | last.lt(one)).any() {
                continue;
            }
            let woken = last * L::splat(token, WOKEN);
            let woken = one.or_where_not(one.lt(woken), woken);
            let eased = (last * L::splat(token, EASED)).max(L::splat(token, LEAST_SHARE));
            let part = eased.or_where_not(turns, woken).or_where_not(creeps, last);
            part.store(share);
            let lags = part.lt(one) & creeps;
            let missing = one - part;
            let change: V3<L> = V3::load(token, displacement);
            let before: V3<L> = V3::load(token, older_displacement);
            let excess = (change - before * kept) * missing;
            let x: V3<L> = V3::load(token, position);
            let lagged = (x - excess).or_where_not(lags, x);
            inverse_area.choose3(token, lagged, x).store(position);
            let lagged = (change - excess).or_where_not(lags, change);
            inverse_area.choose3(token, lagged, change).store(displacement);
            let lagged = v.minus_scaled(v - older * kept, missing).or_where_not(lags, v);
            inverse_area.choose3(token, lagged, v).store(velocity);
        }
    }
}
