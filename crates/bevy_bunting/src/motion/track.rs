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
pub(super) const LEAST_INTERVAL: f64 = 1.0 / 64.0;

/// Speed above which the first change of a new entity's pose is a teleport, m/s: the entity may be put in its place, or
/// have been moving before. Smaller: an entity that starts to move in its second frame swings its cloth late. Larger:
/// cloth that is spawned on a moving vehicle is torn along.
pub(super) const FIRST_SPEED: f32 = 3.0;

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
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Track {
    /// Times (s, ascending) and poses.
    samples: VecDeque<(f64, Isometry3d)>,
    /// Whether the next change is a teleport, of any size.
    pub teleports_next: bool,
    /// Whether it is known how the entity moves: its pose has changed, or has rested.
    pub is_known: bool,
    /// The last change, if that was a teleport that had not been requested.
    jump: Option<Jump>,
}

/// A change of pose that may be the first of a fast motion.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct Jump {
    /// Time of the pose after it, s.
    time: f64,
    /// Mean velocity over the change, m/s.
    velocity: Vec3,
}

/// What a change of pose is besides a motion that goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Departure {
    /// A teleport.
    Teleport(Teleport),
    /// A motion that began with the teleport before: its velocity less that before the teleport, m/s.
    Launch(Vec3),
}

/// A teleport, from a pose to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Teleport {
    pub from: Isometry3d,
    pub to: Isometry3d,
}

impl Teleport {
    /// A pose of the same entity, moved along.
    pub fn carry(&self, pose: Isometry3d) -> Isometry3d {
        if pose == self.from {
            // Without rounding, so that an entity at rest has no motion.
            return self.to;
        }
        let carried = (self.to * self.from.inverse()) * pose;
        Isometry3d { rotation: carried.rotation.normalize(), ..carried }
    }
}

impl Track {
    /// Adds a pose. If it departs from the extrapolated motion by a change of velocity of more than `limit`
    /// m/s, the change is a teleport: all earlier samples are moved along, as if the entity had come from
    /// there. A second such change with the velocity of the first is no teleport but a motion: the entity has been fast
    /// since the first. A pose at the time of the last one replaces it: both changes then belong to one.
    pub fn push(&mut self, time: f64, pose: Isometry3d, limit: f32) -> Option<Departure> {
        if self.samples.back() == Some(&(time, pose)) {
            return None;
        }
        let mut replaced = None;
        while self.samples.back().is_some_and(|&(newest, _)| newest >= time) {
            replaced = self.samples.pop_back().map(|(_, pose)| pose);
        }
        if let (true, Some(earlier)) = (self.samples.is_empty(), replaced) {
            // The replaced pose is the only knowledge of the earlier motion.
            self.samples.push_back((time - LEAST_INTERVAL, earlier));
        }
        let departure = self.departure(time, pose, limit, replaced);
        self.is_known |= self.samples.back().is_some_and(|&(_, last)| last != pose);
        let jump = self.jump.take();
        match departure {
            Some(Departure::Teleport(teleport)) => {
                if !self.teleports_next {
                    let velocity = self.velocity_to(time, pose);
                    self.jump = velocity.map(|velocity| Jump { time, velocity });
                }
                self.teleports_next = false;
                self.carry(&teleport);
            }
            Some(Departure::Launch(_)) => {}
            None => {
                self.jump = jump.filter(|jump| jump.time == time).zip(replaced).and_then(
                    |(jump, replaced)| {
                        let more = self.velocity_between(replaced, pose, time)?;
                        Some(Jump { velocity: jump.velocity + more, ..jump })
                    },
                );
            }
        }
        self.samples.push_back((time, pose));
        if self.samples.len() > MOST_SAMPLES {
            self.samples.pop_front();
        }
        departure
    }

    /// Moves all samples along with a teleport.
    pub fn carry(&mut self, teleport: &Teleport) {
        self.change_poses(|earlier| teleport.carry(earlier));
    }

    /// Changes the poses of all samples.
    pub fn change_poses(&mut self, change: impl Fn(Isometry3d) -> Isometry3d) {
        self.samples.iter_mut().for_each(|(_, pose)| *pose = change(*pose));
    }

    /// Mean velocity from the last pose to a new one, m/s.
    fn velocity_to(&self, time: f64, pose: Isometry3d) -> Option<Vec3> {
        self.velocity_between(self.samples.back()?.1, pose, time)
    }

    /// Mean velocity of a change of pose since the last sample, m/s.
    fn velocity_between(&self, from: Isometry3d, to: Isometry3d, time: f64) -> Option<Vec3> {
        let way = Vec3::from(to.translation - from.translation);
        Some(way / (time - self.samples.back()?.0).max(SHORTEST) as f32)
    }

    /// Whether a pose departs from the extrapolated motion like a teleport.
    pub fn jumps(&self, time: f64, pose: Isometry3d, limit: f32) -> bool {
        matches!(self.departure(time, pose, limit, None), Some(Departure::Teleport(_)))
    }

    /// The departure of a pose from the extrapolated motion: a teleport if the pose is far from the extrapolated, the
    /// last and a `replaced` pose, or if a teleport was requested.
    fn departure(
        &self,
        time: f64,
        pose: Isometry3d,
        limit: f32,
        replaced: Option<Isometry3d>,
    ) -> Option<Departure> {
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
            return Some(Departure::Teleport(Teleport { from: expected, to: pose }));
        }
        let velocity = self.velocity_to(time, pose)?;
        let goes_on = |jump: Jump| {
            jump.time < time
                && jump.velocity.distance(velocity) < limit
                && velocity.length() < FASTEST
        };
        if !turns(last) && self.jump.is_some_and(goes_on) {
            return Some(Departure::Launch(velocity - self.velocity_to(time, expected)?));
        }
        let is_teleport = is_far(last) && is_far(expected) && replaced.is_none_or(is_far);
        is_teleport.then_some(Departure::Teleport(Teleport { from: expected, to: pose }))
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

    /// Adds a time (s) to those of all samples.
    pub fn move_times(&mut self, by: f64) {
        self.samples.iter_mut().for_each(|(time, _)| *time += by);
        self.jump.iter_mut().for_each(|jump| jump.time += by);
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
