//! The parts of the figure's body that the cape may touch: capsules on its bones.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::cape::skeleton::{ANKLE, Joint, LEG, Side};

/// A capsule on a bone.
struct Part {
    joint: Joint,
    /// Ends at rest, in the figure's frame, m.
    ends: [Vec3; 2],
    /// m.
    radius: f32,
}

/// Distance that the cape keeps from the body, m: between two particles, cloth cuts as deep into a forearm.
const MARGIN: f32 = 0.008;

impl Part {
    fn new(joint: Joint, from: impl Into<Vec3>, to: impl Into<Vec3>, radius: f32) -> Self {
        Self { joint, ends: [from.into(), to.into()], radius }
    }

    /// Pose of the capsule in the frame of its joint, m.
    fn pose(&self) -> Transform {
        let [from, to] = self.ends;
        let along = Quat::from_rotation_arc(Vec3::Y, (to - from).normalize());
        Transform::from_translation(from.midpoint(to) - self.joint.place()).with_rotation(along)
    }

    fn collider(&self) -> ClothCollider {
        let half_length = 0.5 * self.ends[0].distance(self.ends[1]);
        ClothCollider {
            margin: MARGIN,
            features: true,
            ..ClothCollider::capsule(half_length, self.radius)
        }
    }
}

fn parts() -> Vec<Part> {
    let mut parts = vec![
        Part::new(Joint::Hips, [-0.06, 0.97, 0.0], [0.06, 0.97, 0.0], 0.12),
        Part::new(Joint::Chest, [-0.07, 1.29, 0.0], [0.07, 1.29, 0.0], 0.12),
        Part::new(Joint::Chest, [-0.17, 1.41, 0.0], [0.17, 1.41, 0.0], 0.06),
    ];
    for side in [Side::Left, Side::Right] {
        let at = |x: f32, y: f32| side.mirrored(x, y);
        parts.extend([
            Part::new(Joint::Arm(side), at(0.2, 1.41), at(0.22, 1.13), 0.05),
            Part::new(Joint::Forearm(side), at(0.22, 1.13), at(0.22, 0.88), 0.042),
            Part::new(Joint::Thigh(side), at(0.1, ANKLE + 2.0 * LEG), at(0.1, ANKLE + LEG), 0.078),
            Part::new(Joint::Shin(side), at(0.1, ANKLE + LEG), at(0.1, ANKLE), 0.055),
        ]);
    }
    parts
}

/// Spawns the parts as colliders on their joints.
pub fn spawn(commands: &mut Commands, joints: &[Entity]) {
    for part in parts() {
        let joint = joints[part.joint.index()];
        commands.spawn((part.collider(), part.pose(), ChildOf(joint)));
    }
}
