//! The pose of a cloth's frame or a collider at the time of each tick, whether it is moved in fixed
//! steps or in frames.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat};

use crate::motion::track::Track;

/// Greatest rate of change of the delay, s/s: the motion seems faster or slower by this fraction.
/// Smaller: the delay lags behind the frame rate. Larger: changes of the frame rate shake the cloth.
const DELAY_RATE: f64 = 0.1;

/// Number of ticks without a change in them, after which a change in a frame means that the entity is
/// moved in frames. Fewer: a target that pauses for a tick is taken for one that is moved in frames.
const QUIET_TICKS: u32 = 4;

/// The schedule in which an entity is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum MovedIn {
    /// A fixed one: once a tick.
    #[default]
    Ticks,
    /// `Update` or later: once a frame.
    Frames,
}

/// A short history of poses, resampled at the time of each tick.
///
/// An entity that is moved in a fixed schedule has one pose a tick: that one is taken. An entity that is
/// moved in `Update` shows none or two changes between ticks: its poses, known at the times of frames,
/// are resampled with a delay of one frame, so that a steady motion stays steady.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct PoseHistory {
    ticks: Track,
    frames: Track,
    moved_in: MovedIn,
    /// Number of ticks until a change in a frame counts again.
    ticks_to_quiet: u32,
    /// Time by which the resampled pose lies in the past, s.
    delay: f64,
    /// The last observed pose.
    last: Option<Isometry3d>,
    /// Poses at the start and the end of the tick.
    span: Option<(Isometry3d, Isometry3d)>,
    /// Set while all samples have one pose: the entity is then not observed until it is moved.
    rest: Option<Rest>,
}

/// Times of the last observations of all entities that do not rest. An entity at rest would have been
/// observed at the same times.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct ObservationTimes {
    /// Time of the last frame, s.
    pub frame: f64,
    /// Length of that frame, s.
    pub frame_length: f64,
    /// End of the last tick, s.
    pub tick: f64,
    /// Number of ticks so far.
    pub ticks: u32,
}

/// An entity at rest.
#[derive(Clone, Copy, Debug)]
struct Rest {
    pose: Isometry3d,
    /// End of the tick since which the entity rests, s.
    tick: f64,
    /// Number of that tick.
    ticks: u32,
}

impl PoseHistory {
    /// The pose at the start of the tick.
    pub fn start(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(start, _)| start)
    }

    /// The pose at the end of the tick.
    pub fn end(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(_, end)| end)
    }

    /// Whether the entity rests, and need not be observed until it is moved.
    pub fn rests(&self) -> bool {
        self.rest.is_some()
    }

    /// Makes the next change of the pose a teleport.
    pub fn teleport_next(&mut self, last: &ObservationTimes) {
        self.end_rest(last);
        self.ticks.teleports_next = true;
        self.frames.teleports_next = true;
    }

    /// Notes the pose in a frame at a time (s); a change of more than `limit` metres is a teleport. A pose
    /// observed `early`, before the frame's ticks, counts only if it changed since the last frame.
    pub fn observe_frame(
        &mut self,
        last: &ObservationTimes,
        time: f64,
        pose: Isometry3d,
        limit: f32,
        early: bool,
    ) {
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        let changed = self.last.is_some_and(|last| last != pose);
        if early && !changed {
            return;
        }
        let teleport = self.frames.push(time, pose, limit);
        if changed && self.moved_in == MovedIn::Ticks && self.ticks_to_quiet == 0 {
            self.moved_in = MovedIn::Frames;
            // The entity has not moved for some ticks: any delay gives the same pose, and the right one
            // can be taken at once.
            self.delay = f64::INFINITY;
        }
        if self.moved_in == MovedIn::Frames {
            self.teleport_end(teleport);
        }
        self.last = Some(pose);
    }

    /// Notes the pose in a tick of `tick` seconds whose times are `now`; a change of more than `limit`
    /// metres is a teleport.
    pub fn observe_tick(
        &mut self,
        last: &ObservationTimes,
        now: &ObservationTimes,
        tick: f64,
        pose: Isometry3d,
        limit: f32,
    ) {
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        let time = now.tick;
        let teleport = self.ticks.push(time, pose, limit);
        if self.last.is_some_and(|last| last != pose) {
            self.moved_in = MovedIn::Ticks;
            self.ticks_to_quiet = QUIET_TICKS;
        } else {
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(1);
        }
        self.last = Some(pose);
        self.change_delay(tick, now.frame_length);
        let track = match self.moved_in {
            MovedIn::Ticks => {
                self.teleport_end(teleport);
                &self.ticks
            }
            MovedIn::Frames => &self.frames,
        };
        let sampled = time - self.delay;
        let end = track.pose_at(sampled).unwrap_or(pose);
        self.span = Some((self.end_or(end), end));
        self.ticks.drop_before(sampled);
        self.frames.drop_before(sampled);
        let rests = self.span == Some((pose, pose))
            && [&self.ticks, &self.frames].iter().all(|track| track.rests_at(pose));
        if rests && !self.frames.is_empty() {
            self.rest = Some(Rest { pose, tick: time, ticks: now.ticks });
        }
    }

    /// Keeps the last pose for a tick in which there is none to be observed.
    pub fn hold(&mut self) {
        self.span = self.span.map(|(_, end)| (end, end));
    }

    /// Changes the delay for `tick` seconds towards zero for an entity that is moved in ticks, or the
    /// length of a `frame` (s) for one that is moved in frames.
    fn change_delay(&mut self, tick: f64, frame: f64) {
        let delay = match self.moved_in {
            MovedIn::Ticks => 0.0,
            MovedIn::Frames => frame,
        };
        self.delay = if self.delay.is_finite() {
            self.delay + (delay - self.delay).clamp(-DELAY_RATE * tick, DELAY_RATE * tick)
        } else {
            delay
        };
    }

    /// Ends a rest, with the state that observations of the resting entity would have led to.
    fn end_rest(&mut self, last: &ObservationTimes) {
        if let Some(rest) = self.rest.take() {
            self.frames.extend(last.frame);
            self.ticks.extend(last.tick);
            let ticks = last.ticks.wrapping_sub(rest.ticks);
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(ticks);
            self.change_delay(last.tick - rest.tick, last.frame_length);
        }
    }

    fn end_or(&self, other: Isometry3d) -> Isometry3d {
        self.span.map_or(other, |(_, end)| end)
    }

    /// Applies a teleport to the pose at the end of the last tick, where the next one starts.
    fn teleport_end(&mut self, teleport: Option<Isometry3d>) {
        if let (Some(teleport), Some((_, end))) = (teleport, &mut self.span) {
            *end = teleport * *end;
            end.rotation = Quat::normalize(end.rotation);
        }
    }
}

#[cfg(test)]
#[path = "pose_tests.rs"]
mod tests;
