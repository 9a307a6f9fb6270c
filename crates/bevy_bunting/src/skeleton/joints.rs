//! The poses of joints in the frame of a cloth, observed like frames.

use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, Isometry3d, Mat3A};
use bevy_time::{Time, Virtual};
use bevy_transform::components::GlobalTransform;
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::motion::attachment::Attachment;
use crate::motion::frame::{frame_of, is_finite};
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::skeleton::skin::ClothSkin;

/// The poses of a skin's joints, in their order.
#[derive(Component, Debug, Default)]
pub(crate) struct JointPoses(Vec<JointPose>);

/// The pose of one joint in the frame of the cloth.
#[derive(Debug)]
struct JointPose {
    joint: Entity,
    /// Whether a vertex is bound to the joint.
    is_used: bool,
    inverse_bind_pose: Affine3A,
    history: PoseHistory,
    /// Scale and shear before the last change, and now.
    shapes: [Mat3A; 2],
    /// Whether the joint's absence was reported.
    is_missed: bool,
}

impl JointPose {
    /// The matrix from the space of the mesh to the cloth's frame, m. That of the bind pose before the first tick.
    fn matrix(&self, pose: Isometry3d, shape: Mat3A) -> Affine3A {
        if !self.history.is_observed() {
            return Affine3A::IDENTITY;
        }
        let shape = Affine3A { matrix3: shape, ..Affine3A::IDENTITY };
        Affine3A::from(pose) * shape * self.inverse_bind_pose
    }
}

/// The pose of one joint of a saved cloth.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedJoint {
    history: PoseHistory,
    shapes: [Mat3A; 2],
    is_missed: bool,
}

impl JointPoses {
    /// What outlives the cloth, joint by joint.
    pub fn saved(&self) -> Vec<SavedJoint> {
        let saved = self.0.iter().map(|pose| SavedJoint {
            history: pose.history.clone(),
            shapes: pose.shapes,
            is_missed: pose.is_missed,
        });
        saved.collect()
    }

    /// Takes over the poses of a saved cloth, joint by joint.
    pub fn restore(&mut self, saved: &[SavedJoint]) {
        for (pose, saved) in self.0.iter_mut().zip(saved) {
            pose.history = saved.history.clone();
            (pose.shapes, pose.is_missed) = (saved.shapes, saved.is_missed);
        }
    }

    /// Moves all times from a clock to another, given the last observation on each.
    pub fn move_times(&mut self, from: &ObservationTimes, to: &ObservationTimes) {
        self.0.iter_mut().for_each(|pose| pose.history.move_times(from, to));
    }

    /// The poses of a valid skin's joints, none of which is observed yet.
    pub fn new(skin: &ClothSkin) -> Self {
        let mut is_used = vec![false; skin.joints.len()];
        for (indices, weights) in skin.joint_indices.iter().zip(&skin.joint_weights) {
            for (&joint, &weight) in indices.iter().zip(weights) {
                if weight > 0.0 {
                    is_used[joint as usize] = true;
                }
            }
        }
        let joints = skin.joints.iter().zip(&skin.inverse_bind_poses).zip(is_used);
        let joints = joints.map(|((&joint, &inverse), is_used)| JointPose {
            joint,
            is_used,
            inverse_bind_pose: Affine3A::from_mat4(inverse),
            history: PoseHistory::default(),
            shapes: [Mat3A::IDENTITY; 2],
            is_missed: false,
        });
        Self(joints.collect())
    }

    /// Whether any joint may move in this tick.
    pub fn may_move(&self) -> bool {
        let moves = |pose: &JointPose| !pose.history.rests() || pose.shapes[0] != pose.shapes[1];
        self.0.iter().any(|pose| pose.is_used && moves(pose))
    }

    /// Makes the next change of each pose a snap.
    pub fn snap_next(&mut self, last: &ObservationTimes) {
        self.0.iter_mut().for_each(|pose| pose.history.teleport_next(last));
    }

    /// Skinning matrices at the start and at the end of the tick, from the space of the mesh to the cloth's frame at that
    /// time, m.
    pub fn matrices(&self) -> [Vec<Affine3A>; 2] {
        let start = |pose: &JointPose| pose.matrix(pose.history.start(), pose.shapes[0]);
        let end = |pose: &JointPose| pose.matrix(pose.history.end(), pose.shapes[1]);
        [self.0.iter().map(start).collect(), self.0.iter().map(end).collect()]
    }

    /// Skinning matrices of the present transforms, given the cloth's frame now. A joint without a finite transform keeps
    /// its last pose.
    pub fn present_matrices(
        &self,
        frame: Isometry3d,
        transforms: &TransformHelper,
    ) -> Vec<Affine3A> {
        let matrix = |pose: &JointPose| {
            let now = transforms.compute_global_transform(pose.joint).ok();
            match now.and_then(|global| in_frame(frame, &global)) {
                Some((now, shape)) if pose.is_used => pose.matrix(now, shape),
                _ => pose.matrix(pose.history.end(), pose.shapes[1]),
            }
        };
        self.0.iter().map(matrix).collect()
    }

    /// Calls `observe` with the history of each joint and its present pose, if it has a finite one.
    fn observe(
        &mut self,
        frame: Isometry3d,
        transforms: &TransformHelper,
        mut observe: impl FnMut(&mut JointPose, Option<(Isometry3d, Mat3A)>),
    ) {
        for pose in self.0.iter_mut().filter(|pose| pose.is_used) {
            let global = transforms.compute_global_transform(pose.joint).ok();
            let now = global.and_then(|global| in_frame(frame, &global));
            observe(pose, now);
        }
    }
}

/// The pose of a transform in a frame, and the scale and shear that it applies before. None if they are not finite.
fn in_frame(frame: Isometry3d, global: &GlobalTransform) -> Option<(Isometry3d, Mat3A)> {
    let in_frame = Affine3A::from(frame.inverse()) * global.affine();
    let (_, rotation, translation) = in_frame.to_scale_rotation_translation();
    let pose = Isometry3d::new(translation, rotation.normalize());
    let shape = Mat3A::from_quat(pose.rotation).transpose() * in_frame.matrix3;
    (is_finite(&pose) && shape.is_finite()).then_some((pose, nearly_none(shape)))
}

/// Error of a shape that is rounding. Smaller: the places of joints at rest tremble by rounding. Larger: a scale of the
/// skeleton is wrong.
const ROUNDING: f32 = 1e-5;

/// The identity where scale and shear are rounding, so that joints that only move keep their shape.
fn nearly_none(shape: Mat3A) -> Mat3A {
    if shape.abs_diff_eq(Mat3A::IDENTITY, ROUNDING) { Mat3A::IDENTITY } else { shape }
}

type ObservedSkin =
    (Entity, &'static ClothSkin, Option<&'static Attachment>, &'static mut JointPoses);

/// Observes all joints in a frame of the app; if `EARLY`, before the ticks of that frame.
pub(super) fn observe_joints_in_frames<const EARLY: bool>(
    mut cloths: Query<ObservedSkin>,
    transforms: TransformHelper,
    time: Res<Time<Virtual>>,
    times: Res<ObservationTimes>,
) {
    let now = time.elapsed_secs_f64();
    for (entity, skin, attachment, mut joints) in &mut cloths {
        let frame = frame_of(entity, attachment, &transforms).filter(is_finite);
        let Some(frame) = frame else { continue };
        joints.observe(frame, &transforms, |pose, observed| {
            if let Some((at, shape)) = observed {
                pose.history.observe_frame(&times, now, at, skin.snap_speed, EARLY);
                if times.stands && !EARLY && pose.shapes[1] != shape {
                    pose.shapes = [shape; 2];
                    pose.history.note_teleport(&times);
                }
            }
        });
    }
}

/// Observes all joints in a tick, and reports those that are missing.
pub(super) fn observe_joints_in_ticks(
    mut cloths: Query<ObservedSkin>,
    transforms: TransformHelper,
    time: Res<Time>,
    times: Res<ObservationTimes>,
    mut commands: Commands,
) {
    let now = times.in_tick(time.elapsed_secs_f64());
    let tick = time.delta_secs_f64();
    for (entity, skin, attachment, mut joints) in &mut cloths {
        let frame = frame_of(entity, attachment, &transforms).filter(is_finite);
        let Some(frame) = frame else { continue };
        joints.observe(frame, &transforms, |pose, observed| {
            pose.shapes[0] = pose.shapes[1];
            match observed {
                Some((at, shape)) => {
                    if !pose.history.is_observed() {
                        pose.shapes[0] = shape;
                    }
                    pose.shapes[1] = shape;
                    pose.history.observe_tick(&times, &now, tick, at, skin.snap_speed);
                }
                None => pose.history.hold(),
            }
            let is_missed = observed.is_none();
            if is_missed && !pose.is_missed {
                let joint = pose.joint;
                ClothFailed::report(
                    &mut commands,
                    entity,
                    ClothError::MissingJoint { entity, joint },
                );
            }
            pose.is_missed = is_missed;
        });
    }
}
