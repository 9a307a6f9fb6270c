//! The parts of a figure's body: capsules on its bones.

use bevy::prelude::*;

use crate::figure::skeleton::Joint;

/// A capsule on a bone.
#[derive(Component, Clone, Copy, Debug)]
pub struct Part {
    /// The joint that moves it.
    pub joint: Joint,
    /// Ends at rest, in the figure's frame, m.
    ends: [Vec3; 2],
    /// m.
    pub radius: f32,
}

impl Part {
    /// A capsule between two places at rest, in the figure's frame, m.
    pub fn new(joint: Joint, from: impl Into<Vec3>, to: impl Into<Vec3>, radius: f32) -> Self {
        Self { joint, ends: [from.into(), to.into()], radius }
    }

    /// Pose of the capsule in the frame of its joint, m.
    pub fn pose(&self) -> Transform {
        let [from, to] = self.ends;
        let along = Quat::from_rotation_arc(Vec3::Y, (to - from).normalize());
        Transform::from_translation(from.midpoint(to) - self.joint.place()).with_rotation(along)
    }

    /// Half the length of its axis, m.
    pub fn half_length(&self) -> f32 {
        0.5 * self.ends[0].distance(self.ends[1])
    }
}
