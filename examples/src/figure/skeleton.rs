//! The skeleton of the figure, which stands upright at rest, faces −z, and is 1.76 m high.

use bevy::prelude::*;

use crate::figure::walker::Walker;

/// A joint.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    Hips,
    Chest,
    Head,
    Arm(Side),
    Forearm(Side),
    Thigh(Side),
    Shin(Side),
}

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Left,
    Right,
}

use Side::{Left, Right};

/// Length of a thigh, and of a shin down to the ankle, m.
pub const LEG: f32 = 0.42;

/// Height of an ankle above the ground, m.
pub const ANKLE: f32 = 0.08;

impl Joint {
    /// All joints, each after its parent.
    pub const ALL: [Self; 11] = [
        Self::Hips,
        Self::Chest,
        Self::Head,
        Self::Arm(Left),
        Self::Arm(Right),
        Self::Forearm(Left),
        Self::Forearm(Right),
        Self::Thigh(Left),
        Self::Thigh(Right),
        Self::Shin(Left),
        Self::Shin(Right),
    ];

    /// Index among all joints.
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|&joint| joint == self).expect("all joints are listed")
    }

    /// The joint that moves this one; none for the root.
    pub fn parent(self) -> Option<Self> {
        Some(match self {
            Self::Hips => return None,
            Self::Chest | Self::Thigh(_) => Self::Hips,
            Self::Head | Self::Arm(_) => Self::Chest,
            Self::Forearm(side) => Self::Arm(side),
            Self::Shin(side) => Self::Thigh(side),
        })
    }

    /// Place at rest, in the figure's frame, m.
    pub fn place(self) -> Vec3 {
        match self {
            Self::Hips => Vec3::new(0.0, 0.95, 0.0),
            Self::Chest => Vec3::new(0.0, 1.12, 0.0),
            Self::Head => Vec3::new(0.0, 1.52, 0.0),
            Self::Arm(side) => side.mirrored(0.2, 1.41),
            Self::Forearm(side) => side.mirrored(0.22, 1.13),
            Self::Thigh(side) => side.mirrored(0.1, ANKLE + 2.0 * LEG),
            Self::Shin(side) => side.mirrored(0.1, ANKLE + LEG),
        }
    }
}

impl Side {
    /// A point at a distance from the middle and a height, m.
    pub fn mirrored(self, x: f32, y: f32) -> Vec3 {
        Vec3::new(if self == Left { -x } else { x }, y, 0.0)
    }
}

/// Spawns a figure with its joints, and returns these in their order.
pub fn spawn(commands: &mut Commands, walker: Walker) -> Vec<Entity> {
    let figure = commands.spawn((walker, Transform::default())).id();
    let mut joints: Vec<Entity> = Vec::new();
    for joint in Joint::ALL {
        let (parent, from) = match joint.parent() {
            Some(parent) => (joints[parent.index()], parent.place()),
            None => (figure, Vec3::ZERO),
        };
        let place = Transform::from_translation(joint.place() - from);
        let spawned = (joint, place, ChildOf(parent));
        joints.push(commands.spawn(spawned).id());
    }
    joints
}
