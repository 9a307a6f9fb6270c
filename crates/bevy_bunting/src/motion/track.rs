//! A track: observed poses of an entity at known times, between which poses are interpolated.

use std::collections::VecDeque;

use bevy_math::{Isometry3d, Vec3};

/// Greatest number of stored poses: it covers the longest delay that Bevy's clock allows at 250 frames a
/// second.
const MOST_SAMPLES: usize = 64;

/// Lever arm that turns a change of angular velocity into one of velocity, m: the size of a flag. Larger:
/// fast spins count as teleports. Smaller: sudden turns swing the cloth about.
const LEVER: f32 = 1.0;

/// Angle between two observations above which a turn is a teleport at any rate, rad: half a turn has no
/// direction.
const TELEPORT_ANGLE: f32 = core::f32::consts::FRAC_PI_2;

/// Least time that a change between two observations is assumed to take, s. Smaller: an entity that the user
/// moves at the rate of ticks, observed in shorter frames, is teleported with each step.
const LEAST_INTERVAL: f64 = 1.0 / 64.0;

/// Speed above which the first change of a new entity's pose is a teleport, m/s: the entity may be put in its place, or
/// have been moving before. Smaller: an entity that starts to move in its second frame swings its cloth late. Larger:
/// cloth that is spawned on a moving vehicle is torn along.
const FIRST_SPEED: f32 = 3.0;

/// Greatest speed, m/s, of a motion that is recognised by two like changes of pose, the first of which is a teleport by its
/// change of velocity: that of a light aircraft. Larger: an entity that is put elsewhere twice, by the same way, throws its cloth.
const FASTEST: f32 = 100.0;

/// Shortest time between two observations from which a velocity is computed, s: a thousand frames a second.
const SHORTEST: f64 = 1e-3;

/// Time past the last observed pose up to which the motion is extrapolated, s: Bevy's clock allows no
/// longer frame.
const LONGEST_EXTRAPOLATION: f64 = 0.25;

/// Observed poses of one entity, on one clock.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    /// Times (s, ascending) and poses.
    samples: VecDeque<(f64, Isometry3d)>,
    /// Whether the next change is a teleport, of any size.
    pub teleports_next: bool,
    /// Whether it is known how the entity moves: its pose has changed, or has rested.
    pub is_known: bool,
    /// Mean velocity over the last change, m/s, if that was a teleport that had not been requested.
    jump: Option<Vec3>,
}

/// What a change of pose is besides a motion that goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Departure {
    /// A teleport, by this transformation.
    Teleport(Isometry3d),
    /// A motion that began with the teleport before: its velocity less that before the teleport, m/s.
    Launch(Vec3),
}

impl Track {
    /// Adds a pose. If it departs from the extrapolated motion by a change of velocity of more than `limit`
    /// m/s, the change is a teleport: all earlier samples are moved along, as if the entity had come from
    /// there. A second such change with the velocity of the first is no teleport but a motion: the entity has been fast
    /// since the first.
    pub fn push(&mut self, time: f64, pose: Isometry3d, limit: f32) -> Option<Departure> {
        let mut replaced = None;
        while self.samples.back().is_some_and(|&(newest, _)| newest >= time) {
            replaced = self.samples.pop_back();
        }
        if let (true, Some((_, earlier))) = (self.samples.is_empty(), replaced) {
            // The replaced pose is the only knowledge of the earlier motion.
            self.samples.push_back((time - LEAST_INTERVAL, earlier));
        }
        let departure = self.departure(time, pose, limit);
        self.is_known |= self.samples.back().is_some_and(|&(_, last)| last != pose);
        self.jump = None;
        if let Some(Departure::Teleport(by)) = departure {
            if !self.teleports_next {
                self.jump = self.velocity_to(time, pose);
            }
            self.teleports_next = false;
            for (_, earlier) in &mut self.samples {
                *earlier = by * *earlier;
            }
        }
        self.samples.push_back((time, pose));
        if self.samples.len() > MOST_SAMPLES {
            self.samples.pop_front();
        }
        departure
    }

    /// Mean velocity from the last pose to a new one, m/s.
    fn velocity_to(&self, time: f64, pose: Isometry3d) -> Option<Vec3> {
        let &(before, last) = self.samples.back()?;
        let way = Vec3::from(pose.translation - last.translation);
        Some(way / (time - before).max(SHORTEST) as f32)
    }

    /// The departure of a pose from the extrapolated motion: a teleport if the pose is far from both the extrapolated
    /// and the last pose, or if a teleport was requested.
    fn departure(&self, time: f64, pose: Isometry3d, limit: f32) -> Option<Departure> {
        let &(before, last) = self.samples.back()?;
        let expected = self.pose_at(time)?;
        let limit = if self.is_known { limit } else { limit.min(FIRST_SPEED) };
        let distance = limit * (time - before).max(LEAST_INTERVAL) as f32;
        let angle = (distance / LEVER).min(TELEPORT_ANGLE);
        let turns = |from: Isometry3d| from.rotation.angle_between(pose.rotation) > angle;
        let is_far = |from: Isometry3d| {
            from.translation.distance(pose.translation) > distance || turns(from)
        };
        if self.teleports_next && pose != last {
            return Some(Departure::Teleport(pose * expected.inverse()));
        }
        let velocity = self.velocity_to(time, pose)?;
        let goes_on = |jump: Vec3| jump.distance(velocity) < limit && velocity.length() < FASTEST;
        if !turns(last) && self.jump.is_some_and(goes_on) {
            return Some(Departure::Launch(velocity - self.velocity_to(time, expected)?));
        }
        if !(is_far(last) && is_far(expected)) {
            return None;
        }
        Some(Departure::Teleport(pose * expected.inverse()))
    }

    /// The pose at a time (s): interpolated between two samples, or extrapolated from the last two.
    pub fn pose_at(&self, time: f64) -> Option<Isometry3d> {
        let after = self
            .samples
            .partition_point(|&(sample, _)| sample < time)
            .min(self.samples.len().saturating_sub(1));
        let &(end, b) = self.samples.get(after)?;
        let Some(&(start, a)) = after.checked_sub(1).and_then(|before| self.samples.get(before))
        else {
            return Some(b);
        };
        let fraction = (time.min(end + LONGEST_EXTRAPOLATION) - start) / (end - start);
        Some(interpolate(a, b, fraction as f32))
    }

    /// Extends the time of the last sample: the same as [`push`](Self::push) of the pose that all samples
    /// have.
    pub fn extend(&mut self, time: f64) {
        if let Some((newest, _)) = self.samples.back_mut() {
            *newest = newest.max(time);
        }
    }

    /// Whether all samples have the given pose and no teleport was requested.
    pub fn rests_at(&self, pose: Isometry3d) -> bool {
        !self.teleports_next && self.samples.iter().all(|&(_, sample)| sample == pose)
    }

    /// Whether nothing has been observed yet.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Drops samples that are not needed for any time from `time` (s) on.
    pub fn drop_before(&mut self, time: f64) {
        while self.samples.len() > 2 && self.samples[1].0 <= time {
            self.samples.pop_front();
        }
    }
}

/// Interpolates two poses. A component that does not change is exact in the result, so that an entity at rest
/// has no motion.
fn interpolate(a: Isometry3d, b: Isometry3d, fraction: f32) -> Isometry3d {
    if a == b || fraction == 1.0 {
        return b;
    }
    let translation = a.translation + (b.translation - a.translation) * fraction;
    let rotation = if a.rotation == b.rotation {
        b.rotation
    } else {
        a.rotation.slerp(b.rotation, fraction).normalize()
    };
    Isometry3d::new(translation, rotation)
}
