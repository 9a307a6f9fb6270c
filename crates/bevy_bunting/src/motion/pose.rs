//! The pose of a cloth's frame or of a collider at the time of each tick, for entities that move in fixed
//! steps or in frames.

mod shift;

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bunting_solver::FrameMotion;
use parry3d::math::Pose;

use crate::cloth::restored::RestoredAt;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::track::{Departure, FIRST_SPEED, Teleport, Track};

/// Greatest rate of change of the delay, s/s; it makes the motion faster or slower by this fraction. Smaller:
/// the delay lags behind the frame rate. Larger: changes of the frame rate shake the cloth.
const DELAY_RATE: f64 = 0.02;

/// Time of rest after which it is known that an entity rested, in units of the longest frame: entities that are moved in
/// frames are not moved in every tick.
const KNOWN_REST: f64 = 1.5;

/// Part of itself by which a scale may be another without a change. Smaller: rounding in turned hierarchies is one. Larger:
/// growth has visible steps.
const SCALE_STEP: f32 = 1.0 / 16_384.0;

/// Number of ticks without a change of pose in them after which a change of pose in a frame means that the
/// entity is moved in frames. Fewer: a target that pauses for a tick is taken for one that is moved in
/// frames.
const QUIET_TICKS: u32 = 4;

/// The schedule in which an entity is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
enum MovedIn {
    /// A schedule of the fixed loop, once a tick.
    #[default]
    Ticks,
    /// Any other schedule, once a frame.
    Frames,
}

/// A short history of poses, resampled at the time of each tick.
///
/// An entity that is moved in a fixed schedule has one pose in each tick, and that pose is used. An entity
/// that is moved in any other schedule changes its pose never or several times between two ticks: its poses at the
/// times of frames are resampled with a delay of one frame, so that a steady motion stays steady. The delay
/// is the length of the longest frames: a delay that followed the length of each frame would shake an entity
/// that moves evenly.
#[derive(Component, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PoseHistory {
    ticks: Track,
    frames: Track,
    moved_in: MovedIn,
    /// Number of ticks until a change in a frame again means that the entity is moved in frames.
    ticks_to_quiet: u32,
    /// Time by which the resampled pose lies in the past, s.
    delay: f64,
    /// The last observed pose.
    last: Option<Isometry3d>,
    /// The last pose while no time passes; none before something changes then.
    standing: Option<Isometry3d>,
    /// Poses at the start and the end of the tick.
    span: Option<(Isometry3d, Isometry3d)>,
    /// Poses at the start and the end of the tick without a delay, extrapolated from the last frame.
    extrapolated: Option<(Isometry3d, Isometry3d)>,
    /// Change of velocity, m/s, at the beginning of a motion that was taken for a teleport then, until a tick in which the
    /// entity moves.
    launching: Option<Vec3>,
    /// That change of velocity, in this tick.
    launched: Option<Vec3>,
    /// Whether a teleport has changed the pose since the last tick.
    teleported: bool,
    /// Set while all samples have one pose: the entity is then not observed until it moves.
    rest: Option<Rest>,
    #[cfg_attr(feature = "serialize", serde(skip))]
    restored: RestoredAt,
    /// Distance by which the pose may be another after the world was moved, m; none once it was observed.
    rounding: Option<f32>,
    /// Scale in the world of the entity that has the pose, in the last tick; none before the first.
    scale: Option<Vec3>,
}

/// An entity at rest.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct Rest {
    pose: Isometry3d,
    /// End of the tick in which the rest began, s.
    tick: f64,
    /// Number of that tick.
    ticks: u32,
}

/// Translation (m) and rotation of a pose.
pub(crate) fn pose_parts(pose: Isometry3d) -> (Vec3, Quat) {
    (pose.translation.into(), pose.rotation)
}

/// A pose as parry has it.
pub(crate) fn parry_pose(pose: Isometry3d) -> Pose {
    let (translation, rotation) = pose_parts(pose);
    Pose::from_parts(translation, rotation)
}

impl PoseHistory {
    /// Whether a tick was observed.
    pub fn is_observed(&self) -> bool {
        self.span.is_some()
    }

    /// The motion in the tick.
    pub fn motion(&self) -> FrameMotion {
        FrameMotion::between(pose_parts(self.start()), pose_parts(self.end()))
    }

    /// The pose at the start of the tick.
    pub fn start(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(start, _)| start)
    }

    /// The pose at the end of the tick.
    pub fn end(&self) -> Isometry3d {
        self.span.map_or(Isometry3d::IDENTITY, |(_, end)| end)
    }

    /// Poses at the start and the end of the tick without a delay, extrapolated from the last frame. Entities
    /// that move alike are extrapolated alike.
    pub fn extrapolated(&self) -> (Isometry3d, Isometry3d) {
        self.extrapolated.unwrap_or_default()
    }

    /// The poses at the end of the tick, with and without a delay: whatever moves or is teleported changes one of them.
    pub fn ends(&self) -> [Option<Isometry3d>; 2] {
        [self.span, self.extrapolated].map(|span| span.map(|(_, end)| end))
    }

    /// Whether the entity rests: it has neither moved nor been teleported since the tick before the last one, and need
    /// not be observed until it moves.
    pub fn rests(&self) -> bool {
        self.rest.is_some()
    }

    /// Makes the next change of the pose a teleport.
    pub fn teleport_next(&mut self, last: &ObservationTimes) {
        self.end_rest(last);
        self.ticks.teleports_next = true;
        self.frames.teleports_next = true;
    }

    /// Keeps the history from resting in the next tick, after a teleport of something that is not in the pose.
    pub fn note_teleport(&mut self, last: &ObservationTimes) {
        self.end_rest(last);
        self.teleported = true;
    }

    /// Scale in the world of the entity that has the pose, or that the cloth is attached to.
    pub fn scale(&self) -> Vec3 {
        self.scale.unwrap_or(Vec3::ONE)
    }

    /// Records the scale in a tick. A change of it ends the rest.
    pub fn observe_scale(&mut self, last: &ObservationTimes, scale: Vec3) {
        let is_same = |known: Vec3| (scale - known).abs().cmple(known.abs() * SCALE_STEP).all();
        if self.scale.is_some_and(is_same) {
            return;
        }
        if self.scale.replace(scale).is_some() {
            self.note_teleport(last);
        }
    }

    /// Records the pose in a frame at a time (s); a change of velocity of more than `limit` m/s is a
    /// teleport, and any change is one while no time passes. A pose observed `early`, before the frame's ticks, is
    /// ignored unless it has changed since the last frame.
    pub fn observe_frame(
        &mut self,
        last: &ObservationTimes,
        time: f64,
        pose: Isometry3d,
        limit: f32,
        early: bool,
    ) {
        self.settle(pose);
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        if last.stands && self.last.is_some() {
            self.observe_standing(last, pose, early);
            return;
        }
        self.standing = None;
        // What has changed before the first frame after a pause may have done so in the pause: it is as unknown as the
        // first change of a new entity.
        if early && last.resumes && self.frames.jumps(time, pose, limit.min(FIRST_SPEED)) {
            self.carry(self.last, pose);
        }
        let changed = self.last.is_some_and(|last| last != pose);
        if early && !changed {
            return;
        }
        let departure = self.frames.push(time, pose, limit);
        if changed && self.moved_in == MovedIn::Ticks && self.ticks_to_quiet == 0 {
            self.moved_in = MovedIn::Frames;
            // The entity has not moved for some ticks, so any delay gives the same pose: the final delay can
            // be set at once.
            self.delay = f64::INFINITY;
        }
        if self.moved_in == MovedIn::Frames {
            self.depart(departure);
        }
        self.last = Some(pose);
    }

    /// Records the pose after the ticks of a frame, before anything outside the fixed loop moves the entity. If it has
    /// changed since the last tick, the entity is moved in ticks, after the cloths'.
    pub fn observe_end_of_ticks(&mut self, last: &ObservationTimes, pose: Isometry3d) {
        self.settle(pose);
        if last.has_ticked() && self.last.is_some_and(|last| last != pose) {
            self.end_rest(last);
            self.last = Some(pose);
            self.moved_in = MovedIn::Ticks;
            self.ticks_to_quiet = QUIET_TICKS;
        }
    }

    /// Records the pose in a frame in which no time passes: any change is a teleport. A change before the ticks of the first
    /// such frame is none, but happened in the frame before, after the observation of that.
    fn observe_standing(&mut self, last: &ObservationTimes, pose: Isometry3d, early: bool) {
        if !early {
            self.carry(self.standing.or(self.last), pose);
        }
        if !early || last.begins_to_stand {
            self.standing = Some(pose);
        }
    }

    /// Moves all poses along with a teleport while no time passes.
    fn carry(&mut self, from: Option<Isometry3d>, to: Isometry3d) {
        let Some(from) = from.filter(|from| *from != to) else { return };
        let teleport = Teleport { from, to };
        for track in [&mut self.ticks, &mut self.frames] {
            track.teleports_next = false;
            track.carry(&teleport);
        }
        self.depart(Some(Departure::Teleport(teleport)));
        self.last = self.last.map(|last| teleport.carry(last));
    }

    /// Records the pose in a tick of `tick` seconds whose times are `now`; a change of velocity of more than
    /// `limit` m/s is a teleport.
    pub fn observe_tick(
        &mut self,
        last: &ObservationTimes,
        now: &ObservationTimes,
        tick: f64,
        pose: Isometry3d,
        limit: f32,
    ) {
        self.settle(pose);
        if self.rest.is_some_and(|rest| rest.pose == pose) {
            return;
        }
        self.end_rest(last);
        self.standing = None;
        self.launched = None;
        let time = now.tick;
        if self.frames.is_empty() {
            // The entity had this pose in the last frame; a motion later in this frame starts from it.
            self.frames.push(now.frame, pose, limit);
        }
        let departure = self.ticks.push(time, pose, limit);
        if self.last.is_some_and(|last| last != pose) {
            self.moved_in = MovedIn::Ticks;
            self.ticks_to_quiet = QUIET_TICKS;
        } else {
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(1);
        }
        self.last = Some(pose);
        self.change_delay(tick, now.longest_frame);
        let track = match self.moved_in {
            MovedIn::Ticks => {
                self.depart(departure);
                &self.ticks
            }
            MovedIn::Frames => &self.frames,
        };
        let sampled = time - self.delay;
        let is_new = !self.is_observed();
        let end = track.pose_at(sampled).unwrap_or(pose);
        self.span = Some((self.end_or(end), end));
        if self.start() != end {
            self.launched = self.launching.take();
        }
        let end = track.pose_at(time).unwrap_or(pose);
        self.extrapolated = Some((self.extrapolated.map_or(end, |(_, end)| end), end));
        self.ticks.drop_before(sampled);
        self.frames.drop_before(sampled);
        // What is new or was teleported rests one tick later, so that sleeping cloth that depends on it wakes.
        let rested = !core::mem::take(&mut self.teleported) && !is_new;
        let rests = rested
            && self.span == Some((pose, pose))
            && self.extrapolated == self.span
            && [&self.ticks, &self.frames].iter().all(|track| track.rests_at(pose));
        if rests && !self.frames.is_empty() {
            self.rest = Some(Rest { pose, tick: time, ticks: now.ticks });
        }
    }

    /// Keeps the last pose for a tick in which no pose can be observed.
    pub fn hold(&mut self) {
        self.span = self.span.map(|(_, end)| (end, end));
        self.extrapolated = self.extrapolated.map(|(_, end)| (end, end));
        self.launched = None;
    }

    /// Moves the delay during `tick` seconds towards zero for an entity that is moved in ticks, or towards
    /// the length of a `frame` (s) for one that is moved in frames.
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

    /// Ends a rest, with the state that observing the resting entity would have led to.
    fn end_rest(&mut self, last: &ObservationTimes) {
        if let Some(rest) = self.rest.take() {
            self.frames.extend(last.frame);
            self.ticks.extend(last.tick);
            let ticks = last.ticks.wrapping_sub(rest.ticks);
            self.ticks_to_quiet = self.ticks_to_quiet.saturating_sub(ticks);
            self.change_delay(last.tick - rest.tick, last.longest_frame);
            if last.tick - rest.tick > KNOWN_REST * last.longest_frame {
                self.ticks.is_known = true;
                self.frames.is_known = true;
            }
        }
    }

    fn end_or(&self, other: Isometry3d) -> Isometry3d {
        self.span.map_or(other, |(_, end)| end)
    }

    /// Applies a teleport to the pose at the end of the last tick, which is the start of the next tick; or notes the
    /// beginning of a motion.
    fn depart(&mut self, departure: Option<Departure>) {
        match departure {
            None => {}
            Some(Departure::Launch(velocity)) => self.launching = Some(velocity),
            Some(Departure::Teleport(teleport)) => {
                self.launching = None;
                self.teleported = true;
                for (_, end) in [&mut self.span, &mut self.extrapolated].into_iter().flatten() {
                    *end = teleport.carry(*end);
                }
            }
        }
    }

    /// Moves all times from a clock to another, given the last observation on each.
    pub fn move_times(&mut self, from: &ObservationTimes, to: &ObservationTimes) {
        let by = to.tick - from.tick;
        if by != 0.0 {
            [&mut self.ticks, &mut self.frames].into_iter().for_each(|track| track.move_times(by));
        }
        if let Some(rest) = &mut self.rest {
            rest.tick += by;
            rest.ticks = rest.ticks.wrapping_add(to.ticks).wrapping_sub(from.ticks);
        }
    }

    /// Notes that the entity was restored at a tick of change.
    pub fn note_restored(&mut self, at: RestoredAt) {
        self.restored = at;
    }

    /// When the entity was restored, if that was since the last tick.
    pub fn restored(&self) -> RestoredAt {
        self.restored
    }

    /// Whether a component of the entity has changed since a system last ran, other than before a restoration: what was
    /// restored is not new.
    pub fn has_new<C: Component>(&self, component: &Ref<C>) -> bool {
        component.is_changed() && self.restored.is_before(component.last_changed())
    }

    /// Change of the entity's velocity, m/s, if a motion begins in this tick whose beginning was taken for a teleport.
    pub fn launch(&self) -> Option<Vec3> {
        self.launched
    }
}

#[cfg(test)]
#[path = "pose_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "schedule_tests.rs"]
mod schedule_tests;
