//! The poses of anchors' targets, observed like the frames of cloths.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::helper::TransformHelper;

use crate::motion::attachment::{Anchor, Attachment};
use crate::motion::frame::{frame_on, is_finite};
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;

/// The poses of a cloth's anchors, in their order.
#[derive(Component, Debug, Default)]
pub(crate) struct AnchorPoses(Vec<AnchorPose>);

/// The pose of one anchor.
#[derive(Debug)]
struct AnchorPose {
    target: Entity,
    history: PoseHistory,
}

impl AnchorPoses {
    /// The poses of anchors whose histories are known, in their order.
    pub fn restored(anchors: &[Anchor], histories: &[PoseHistory]) -> Self {
        let poses = anchors.iter().zip(histories);
        let pose = |(anchor, history): (&Anchor, &PoseHistory)| AnchorPose {
            target: anchor.target,
            history: history.clone(),
        };
        Self(poses.map(pose).collect())
    }

    /// The histories of the anchors' poses, in their order.
    pub fn histories(&self) -> impl Iterator<Item = &PoseHistory> {
        self.0.iter().map(|pose| &pose.history)
    }

    /// Moves all times from a clock to another, given the last observation on each.
    pub fn move_times(&mut self, from: &ObservationTimes, to: &ObservationTimes) {
        self.0.iter_mut().for_each(|pose| pose.history.move_times(from, to));
    }

    /// Poses of an anchor at the start and the end of the tick. None before its first tick.
    pub fn span(&self, anchor: usize) -> Option<(Isometry3d, Isometry3d)> {
        let history = &self.0.get(anchor)?.history;
        history.is_observed().then(|| (history.start(), history.end()))
    }

    /// Whether an anchor rests.
    pub fn rests(&self, anchor: usize) -> bool {
        self.0.get(anchor).is_some_and(|pose| pose.history.rests())
    }

    /// Whether any anchor may move in this tick.
    pub fn may_move(&self) -> bool {
        self.0.iter().any(|pose| !pose.history.rests())
    }

    /// Makes the next change of each pose a teleport.
    pub fn teleport_next(&mut self, last: &ObservationTimes) {
        self.0.iter_mut().for_each(|pose| pose.history.teleport_next(last));
    }

    /// Moves all poses along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        self.0.iter_mut().for_each(|pose| pose.history.shift(by));
    }

    /// Forgets the poses of targets that are no longer those of the anchors. An anchor that moves up in the list, since one
    /// before it was removed, keeps its poses.
    fn fit(&mut self, anchors: &[Anchor]) {
        let is_of = |(pose, anchor): (&AnchorPose, &Anchor)| pose.target == anchor.target;
        if self.0.len() == anchors.len() && self.0.iter().zip(anchors).all(is_of) {
            return;
        }
        let mut former = core::mem::take(&mut self.0);
        self.0.extend(anchors.iter().map(|anchor| {
            let index = former.iter().position(|pose| pose.target == anchor.target);
            let known = index.map(|index| former.remove(index));
            known.unwrap_or(AnchorPose { target: anchor.target, history: PoseHistory::default() })
        }));
    }

    /// Calls `observe` with the history of each anchor and its present pose, if it has one.
    fn observe(
        &mut self,
        anchors: &[Anchor],
        transforms: &TransformHelper,
        mut observe: impl FnMut(&mut PoseHistory, Option<Isometry3d>),
    ) {
        self.fit(anchors);
        for (pose, anchor) in self.0.iter_mut().zip(anchors) {
            let target = transforms.compute_global_transform(anchor.target).ok();
            let target = target.filter(|_| !anchor.brings_first);
            let now = target.map(|target| frame_on(&target, &anchor.offset)).filter(is_finite);
            observe(&mut pose.history, now);
        }
    }
}

/// Observes all anchors in a frame of the app; if `EARLY`, before the ticks of that frame.
pub(super) fn observe_anchors_in_frames<const EARLY: bool>(
    mut cloths: Query<(&Attachment, &mut AnchorPoses)>,
    transforms: TransformHelper,
    time: Res<Time<Virtual>>,
    times: Res<ObservationTimes>,
) {
    let now = time.elapsed_secs_f64();
    for (attachment, mut poses) in &mut cloths {
        poses.observe(&attachment.anchors, &transforms, |history, pose| {
            if let Some(pose) = pose {
                history.observe_frame(&times, now, pose, attachment.teleport_speed, EARLY);
            }
        });
    }
}

/// Observes all anchors after the ticks of a frame of the app.
pub(super) fn observe_anchors_at_end_of_ticks(
    mut cloths: Query<(&Attachment, &mut AnchorPoses)>,
    transforms: TransformHelper,
    times: Res<ObservationTimes>,
) {
    for (attachment, mut poses) in &mut cloths {
        poses.observe(&attachment.anchors, &transforms, |history, pose| {
            if let Some(pose) = pose {
                history.observe_end_of_ticks(&times, pose);
            }
        });
    }
}

/// Observes all anchors in a tick.
pub(super) fn observe_anchors_in_ticks(
    mut cloths: Query<(&Attachment, &mut AnchorPoses)>,
    transforms: TransformHelper,
    time: Res<Time>,
    times: Res<ObservationTimes>,
) {
    let now = times.in_tick(time.elapsed_secs_f64());
    let tick = time.delta_secs_f64();
    for (attachment, mut poses) in &mut cloths {
        poses.observe(&attachment.anchors, &transforms, |history, pose| match pose {
            Some(pose) => {
                history.observe_tick(&times, &now, tick, pose, attachment.teleport_speed);
            }
            None => history.hold(),
        });
    }
}
