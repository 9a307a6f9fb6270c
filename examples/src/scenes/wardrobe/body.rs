//! The body that wears the clothes: capsules on its bones.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::figure::part::Part;
use crate::figure::skeleton::{ANKLE, Joint, LEG, Side};
use crate::scenes::wardrobe::layers::{ARMS, BARE, BODY, CLOTHES, SKIRTED};

/// Distance that clothes keep from trunk and arms, m. Between two particles, cloth cuts as deep into a limb.
const MARGIN: f32 = 0.014;

/// Distance that clothes keep from legs, m: knees come fast.
const LEG_MARGIN: f32 = 0.018;

/// Distance that clothes keep from hips and thighs on which there is a skirt, m.
const OVER_SKIRT: f32 = 0.045;

/// Friction coefficient of skin: clothes slide on it.
const FRICTION: f32 = 0.2;

fn trunk() -> [Part; 5] {
    [
        Part::new(Joint::Chest, [-0.04, 1.12, 0.0], [0.04, 1.12, 0.0], 0.105),
        Part::new(Joint::Chest, [-0.06, 1.28, 0.0], [0.06, 1.28, 0.0], 0.115),
        Part::new(Joint::Chest, [-0.135, 1.41, 0.0], [0.135, 1.41, 0.0], 0.05),
        Part::new(Joint::Chest, [0.0, 1.42, 0.0], [0.0, 1.54, 0.0], 0.05),
        Part::new(Joint::Head, [0.0, 1.61, -0.01], [0.0, 1.67, -0.01], 0.085),
    ]
}

fn hips() -> Part {
    Part::new(Joint::Hips, [-0.075, 0.96, 0.0], [0.075, 0.96, 0.0], 0.085)
}

fn thigh(side: Side) -> Part {
    let at = |y: f32| side.mirrored(0.1, y);
    Part::new(Joint::Thigh(side), at(ANKLE + 2.0 * LEG), at(ANKLE + LEG), 0.072)
}

fn shin(side: Side) -> Part {
    let at = |y: f32| side.mirrored(0.1, y);
    Part::new(Joint::Shin(side), at(ANKLE + LEG), at(ANKLE), 0.052)
}

fn arm(side: Side) -> [Part; 2] {
    let at = |x: f32, y: f32| side.mirrored(x, y);
    [
        Part::new(Joint::Arm(side), at(0.2, 1.41), at(0.22, 1.13), 0.045),
        Part::new(Joint::Forearm(side), at(0.22, 1.13), at(0.22, 0.86), 0.038),
    ]
}

/// Spawns the parts as colliders on their joints.
pub fn spawn(commands: &mut Commands, joints: &[Entity]) {
    let mut spawn = |part: Part, margin: f32, layer: u32| {
        let shape = ClothCollider::capsule(part.half_length(), part.radius);
        let collider = ClothCollider { margin, friction: FRICTION, ..shape };
        let layers = ClothLayers::new(layer, CLOTHES);
        let held = ChildOf(joints[part.joint.index()]);
        commands.spawn((part, collider, layers, part.pose(), held));
    };
    for side in [Side::Left, Side::Right] {
        spawn(shin(side), LEG_MARGIN, BODY);
        arm(side).into_iter().for_each(|part| spawn(part, MARGIN, ARMS));
    }
    trunk().into_iter().for_each(|part| spawn(part, MARGIN, BODY));
    for part in [hips(), thigh(Side::Left), thigh(Side::Right)] {
        spawn(part, LEG_MARGIN, BARE);
        spawn(part, OVER_SKIRT, SKIRTED);
    }
}
