//! The parts of the figure's body that the cape may touch: capsules on its bones.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::figure::part::Part;
use crate::figure::skeleton::{ANKLE, Joint, LEG, Side};

/// Distance that the cape keeps from the body, m: between two particles, cloth cuts as deep into a forearm.
const MARGIN: f32 = 0.008;

fn collider(part: &Part) -> ClothCollider {
    ClothCollider {
        margin: MARGIN,
        features: true,
        ..ClothCollider::capsule(part.half_length(), part.radius)
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
        commands.spawn((collider(&part), part.pose(), ChildOf(joint)));
    }
}
