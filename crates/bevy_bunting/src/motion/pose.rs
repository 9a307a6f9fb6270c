//! Where something is at the time of a tick, whenever it is moved.

use std::collections::VecDeque;

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat};

/// Poses kept of one thing: at 250 frames a second, the longest delay that Bevy's clock allows.
const MOST_SAMPLES: usize = 64;

/// Lever at which a change of angular velocity counts as one of velocity, m: the size of a flag.
const LEVER: f32 = 1.0;

/// A turn between two observations of more than this is a teleport, however far apart they are, rad.
const TELEPORT_ANGLE: f32 = core::f32::consts::FRAC_PI_2;

/// Least time in which a change between two observations came about, s: what is moved at the rate of ticks by a
/// loop of its own makes its steps within one of several short frames.
const LEAST_INTERVAL: f64 = 1.0 / 64.0;

/// How far a course is followed past the last pose seen, s: Bevy's clock allows no longer frame.
const LONGEST_COURSE: f64 = 0.25;

/// How fast the delay may change, seconds a second: the motion seems that much faster or slower. At 0.1 a
/// flag at 20 m/s feels a change of its pole's speed by 2 m/s with each frame that is longer than the last.
const DELAY_RATE: f64 = 0.02;

/// Ticks without a change between them after which what changes in frames is moved by frames.
const QUIET_TICKS: u32 = 4;

/// Poses of one thing at known times, on one clock.
#[derive(Clone, Debug, Default)]
struct Track {
    samples: VecDeque<(f64, Isometry3d)>,
    /// The next change is a teleport, however small.
    jump_next: bool,
}

impl Track {
    /// Adds a pose. If it is off the course by a change of velocity of more than `limit` m/s, the past is
    /// carried along, as if it had been there all the time, and the change of coordinates returned.
    fn push(&mut self, time: f64, pose: Isometry3d, limit: f32) -> Option<Isometry3d> {
        let mut replaced = None;
        while self.samples.back().is_some_and(|&(newest, _)| newest >= time) {
            replaced = self.samples.pop_back();
        }
        if self.samples.is_empty() {
            // All that is known of its course.
            self.samples.extend(replaced.map(|(_, pose)| (time - LEAST_INTERVAL, pose)));
        }
        let jump = self.jump(time, pose, limit);
        if let Some(jump) = jump {
            self.jump_next = false;
            for (_, past) in &mut self.samples {
                *past = jump * *past;
            }
        }
        self.samples.push_back((time, pose));
        if self.samples.len() > MOST_SAMPLES {
            self.samples.pop_front();
        }
        jump
    }

    fn jump(&self, time: f64, pose: Isometry3d, limit: f32) -> Option<Isometry3d> {
        let &(before, last) = self.samples.back()?;
        let expected = self.pose_at(time)?;
        let distance = limit * (time - before).max(LEAST_INTERVAL) as f32;
        let angle = (distance / LEVER).min(TELEPORT_ANGLE);
        let off = |from: Isometry3d| {
            from.translation.distance(pose.translation) > distance
                || from.rotation.angle_between(pose.rotation) > angle
        };
        let jumps = (self.jump_next && pose != last) || (off(last) && off(expected));
        jumps.then(|| pose * expected.inverse())
    }

    /// The pose at a time: between two samples, or further along the course of the last two.
    fn pose_at(&self, time: f64) -> Option<Isometry3d> {
        let after = self
            .samples
            .partition_point(|&(sample, _)| sample < time)
            .min(self.samples.len().saturating_sub(1));
        let &(end, b) = self.samples.get(after)?;
        let Some(&(start, a)) = after.checked_sub(1).and_then(|before| self.samples.get(before))
        else {
            return Some(b);
        };
        let part = (time.min(end + LONGEST_COURSE) - start) / (end - start);
        Some(blend(a, b, part as f32))
    }

    /// What [`push`](Self::push) does with the pose that all samples have: stretches their time.
    fn extend(&mut self, time: f64) {
        if let Some((newest, _)) = self.samples.back_mut() {
            *newest = newest.max(time);
        }
    }

    /// Whether this is the only pose.
    fn rests_at(&self, pose: Isometry3d) -> bool {
        !self.jump_next && self.samples.iter().all(|&(_, sample)| sample == pose)
    }

    /// Forgets what is not needed for any time from this one on.
    fn forget_before(&mut self, time: f64) {
        while self.samples.len() > 2 && self.samples[1].0 <= time {
            self.samples.pop_front();
        }
    }
}

/// Exact where nothing moves, axis by axis, so that what rests feeds no motion.
fn blend(a: Isometry3d, b: Isometry3d, part: f32) -> Isometry3d {
    if a == b || part == 1.0 {
        return b;
    }
    let translation = a.translation + (b.translation - a.translation) * part;
    let rotation = if a.rotation == b.rotation {
        b.rotation
    } else {
        a.rotation.slerp(b.rotation, part).normalize()
    };
    Isometry3d::new(translation, rotation)
}

/// Whether something is moved once a tick or once a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum MovedBy {
    #[default]
    Ticks,
    Frames,
}

/// A short history of poses, resampled at the time of each tick.
///
/// What is moved in a fixed schedule has one pose a tick: that one is taken. What is moved in
/// `Update` shows none or two changes between ticks: its poses, known at the times of frames, are
/// resampled one frame's length ago, so that a steady motion stays steady. That length is one of the longest
/// of late, as a delay that followed each frame would shake what moves evenly.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct PoseHistory {
    ticks: Track,
    frames: Track,
    moved_by: MovedBy,
    /// Ticks until a change in a frame counts again.
    ticks_to_quiet: u32,
    /// How long ago the poses are resampled, s.
    delay: f64,
    seen: Option<Isometry3d>,
    span: Option<(Isometry3d, Isometry3d)>,
    /// The same without a delay: where the course leads since the last frame.
    ahead: Option<(Isometry3d, Isometry3d)>,
    /// Where it rests, if all samples say so: most things do, and then nobody looks at them.
    rest: Option<Rest>,
}

/// When everything was last looked at that does not rest: what rests would have been there, too.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Observed {
    /// Time of the last frame, s.
    pub frame: f64,
    /// Mean length of frames of late, s.
    pub mean_frame: f64,
    /// Length of the longest frames of late, hitches apart, s.
    pub frame_length: f64,
    /// End of the last tick, s.
    pub tick: f64,
    /// Number of ticks so far.
    pub ticks: u32,
}

/// Something that rests.
#[derive(Clone, Copy, Debug)]
struct Rest {
    pose: Isometry3d,
    /// End of the tick since when it rests, s.
    tick: f64,
    /// Number of that tick.
    ticks: u32,
}

/// Times in which the mean length of frames and the longest of late follow those of frames, s.
const MEAN_TIME: f64 = 0.5;
const LONGEST_TIME: f64 = 2.0;

/// A frame of more than this many times the mean length is a hitch: motion after it is extrapolated.
const HITCH: f64 = 1.5;

impl Observed {
    /// Notes the length of a frame, s.
    pub fn note_frame(&mut self, length: f64) {
        if length <= 0.0 {
            return;
        }
        if self.mean_frame == 0.0 {
            (self.mean_frame, self.frame_length) = (length, length);
        }
        self.mean_frame += (length - self.mean_frame) * (length / MEAN_TIME).min(1.0);
        let excess = self.frame_length - self.mean_frame;
        let eased = self.frame_length - excess * (length / LONGEST_TIME).min(1.0);
        self.frame_length = eased.max(length.min(HITCH * self.mean_frame));
    }
}

impl PoseHistory {
    /// Whether there was a tick.
    pub fn is_known(&self) -> bool {
        self.span.is_some()
    }

    /// The pose at the start of the tick.
    pub fn start(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(start, _)| start)
    }

    /// The pose at the end of the tick.
    pub fn end(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(_, end)| end)
    }

    /// Poses at the start and the end of the tick without a delay, extrapolated since the last frame: where
    /// things are relative to one another. Two that move alike are extrapolated alike.
    pub fn ahead(&self) -> (Isometry3d, Isometry3d) {
        self.ahead.unwrap_or_default()
    }

    /// Whether it has not moved lately: it need not be looked at until something moves it.
    pub fn rests(&self) -> bool {
        self.rest.is_some()
    }

    /// The next change of the pose is a teleport: what follows it is carried along.
    pub fn jump_next(&mut self, last: &Observed) {
        self.end_rest(last);
        self.ticks.jump_next = true;
        self.frames.jump_next = true;
    }

    /// The pose in a frame, at the frame's time. One seen `early`, before the frame's ticks, counts
    /// only if it was moved since the last frame.
    pub fn observe_frame(
        &mut self,
        last: &Observed,
        time: f64,
        pose: Isometry3d,
        limit: f32,
        early: bool,
    ) {
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        let changed = self.seen.is_some_and(|seen| seen != pose);
        if early && !changed {
            return;
        }
        let jump = self.frames.push(time, pose, limit);
        if changed && self.moved_by == MovedBy::Ticks && self.ticks_to_quiet == 0 {
            self.moved_by = MovedBy::Frames;
            // It has not moved for a while, so it was there a frame ago, too.
            self.delay = f64::INFINITY;
        }
        if self.moved_by == MovedBy::Frames {
            self.carry(jump);
        }
        self.seen = Some(pose);
    }

    /// The pose in a tick of `tick` seconds, which is the one `now`.
    pub fn observe_tick(
        &mut self,
        last: &Observed,
        now: &Observed,
        tick: f64,
        pose: Isometry3d,
        limit: f32,
    ) {
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        let time = now.tick;
        if self.frames.samples.is_empty() {
            // What is moved in this frame was here before.
            self.frames.push(now.frame, pose, limit);
        }
        let jump = self.ticks.push(time, pose, limit);
        if self.seen.is_some_and(|seen| seen != pose) {
            self.moved_by = MovedBy::Ticks;
            self.ticks_to_quiet = QUIET_TICKS;
        } else {
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(1);
        }
        self.seen = Some(pose);
        self.change_delay(tick, now.frame_length);
        let track = match self.moved_by {
            MovedBy::Ticks => {
                self.carry(jump);
                &self.ticks
            }
            MovedBy::Frames => &self.frames,
        };
        let sampled = time - self.delay;
        let end = track.pose_at(sampled).unwrap_or(pose);
        self.span = Some((self.end_or(end), end));
        let end = track.pose_at(time).unwrap_or(pose);
        self.ahead = Some((self.ahead.map_or(end, |(_, end)| end), end));
        self.ticks.forget_before(sampled);
        self.frames.forget_before(sampled);
        let rests = self.span == Some((pose, pose))
            && self.ahead == self.span
            && [&self.ticks, &self.frames].iter().all(|track| track.rests_at(pose));
        if rests && !self.frames.samples.is_empty() {
            self.rest = Some(Rest { pose, tick: time, ticks: now.ticks });
        }
    }

    /// Lets the delay tend, for so many seconds, to what suits how the thing is moved.
    fn change_delay(&mut self, tick: f64, frame: f64) {
        let delay = match self.moved_by {
            MovedBy::Ticks => 0.0,
            MovedBy::Frames => frame,
        };
        self.delay = if self.delay.is_finite() {
            self.delay + (delay - self.delay).clamp(-DELAY_RATE * tick, DELAY_RATE * tick)
        } else {
            delay
        };
    }

    /// Brings everything up to date, as if it had been looked at all the time.
    fn end_rest(&mut self, last: &Observed) {
        if let Some(rest) = self.rest.take() {
            self.frames.extend(last.frame);
            self.ticks.extend(last.tick);
            let ticks = last.ticks.wrapping_sub(rest.ticks);
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(ticks);
            self.change_delay(last.tick - rest.tick, last.frame_length);
        }
    }

    /// Stays where it is, as what has no pose to be observed.
    pub fn stay(&mut self) {
        self.span = self.span.map(|(_, end)| (end, end));
        self.ahead = self.ahead.map(|(_, end)| (end, end));
    }

    fn end_or(&self, other: Isometry3d) -> Isometry3d {
        self.span.map_or(other, |(_, end)| end)
    }

    fn carry(&mut self, jump: Option<Isometry3d>) {
        let Some(jump) = jump else { return };
        for (_, end) in [&mut self.span, &mut self.ahead].into_iter().flatten() {
            *end = jump * *end;
            end.rotation = Quat::normalize(end.rotation);
        }
    }
}

#[cfg(test)]
#[path = "pose_tests.rs"]
mod tests;
