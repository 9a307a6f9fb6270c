//! The parts of the figure's body: capsules on its bones, which the cape does not enter.

use crate::limits::greatest;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::cape::skeleton::{ANKLE, Joint, LEG, Side};

/// A capsule on a bone.
#[derive(Component, Clone, Copy, Debug)]
pub struct Part {
    pub joint: Joint,
    /// Ends at rest, in the figure's frame, m.
    pub ends: [Vec3; 2],
    /// Radius, m.
    pub radius: f32,
    /// Whether the cape may come near.
    pub is_solid: bool,
}

/// Distance that the cape keeps from the body, m: between two particles, cloth cuts as deep into a forearm.
const MARGIN: f32 = 0.008;

impl Part {
    fn new(joint: Joint, from: impl Into<Vec3>, to: impl Into<Vec3>, radius: f32) -> Self {
        Self { joint, ends: [from.into(), to.into()], radius, is_solid: true }
    }

    /// A part that the cape does not reach, or that lies within others.
    fn inner(self) -> Self {
        Self { is_solid: false, ..self }
    }

    /// Pose of the capsule in the frame of its joint, m.
    pub fn pose(&self) -> Transform {
        let [from, to] = self.ends;
        let along = Quat::from_rotation_arc(Vec3::Y, (to - from).normalize());
        Transform::from_translation(from.midpoint(to) - self.joint.place()).with_rotation(along)
    }

    /// Half the distance of its ends, m.
    pub fn half_length(&self) -> f32 {
        0.5 * self.ends[0].distance(self.ends[1])
    }
}

/// All parts.
pub fn parts() -> Vec<Part> {
    let mut parts = vec![
        Part::new(Joint::Hips, [-0.06, 0.97, 0.0], [0.06, 0.97, 0.0], 0.12),
        Part::new(Joint::Chest, [0.0, 1.05, 0.0], [0.0, 1.2, 0.0], 0.115).inner(),
        Part::new(Joint::Chest, [-0.07, 1.29, 0.0], [0.07, 1.29, 0.0], 0.12),
        Part::new(Joint::Chest, [-0.17, 1.41, 0.0], [0.17, 1.41, 0.0], 0.06),
        Part::new(Joint::Chest, [0.0, 1.42, 0.0], [0.0, 1.55, -0.01], 0.05).inner(),
        Part::new(Joint::Head, [0.0, 1.60, -0.02], [0.0, 1.67, -0.02], 0.09).inner(),
    ];
    for side in [Side::Left, Side::Right] {
        let at = |x: f32, y: f32| side.mirrored(x, y);
        let foot = at(0.1, 0.5 * ANKLE);
        parts.extend([
            Part::new(Joint::Arm(side), at(0.2, 1.41), at(0.22, 1.13), 0.05),
            Part::new(Joint::Forearm(side), at(0.22, 1.13), at(0.22, 0.88), 0.042),
            Part::new(Joint::Forearm(side), at(0.22, 0.85), at(0.22, 0.8), 0.045).inner(),
            Part::new(Joint::Thigh(side), at(0.1, ANKLE + 2.0 * LEG), at(0.1, ANKLE + LEG), 0.078),
            Part::new(Joint::Shin(side), at(0.1, ANKLE + LEG), at(0.1, ANKLE), 0.055),
            Part::new(Joint::Shin(side), foot + 0.03 * Vec3::Z, foot - 0.15 * Vec3::Z, 0.045)
                .inner(),
        ]);
    }
    parts
}

/// Spawns the parts as colliders on their joints.
pub fn spawn(commands: &mut Commands, joints: &[Entity]) {
    for part in parts().into_iter().filter(|part| part.is_solid) {
        let shape = ClothCollider::capsule(part.half_length(), part.radius);
        commands.spawn((
            part,
            // The mesh of the cape is finer than the limbs are thick, so that contacts of particles are enough.
            ClothCollider { margin: MARGIN, features: false, ..shape },
            part.pose(),
            ChildOf(joints[part.joint.index()]),
        ));
    }
}

/// Greatest depth of a particle of any cloth in the body, m.
pub fn depth(world: &mut World) -> f32 {
    let capsules: Vec<([Vec3; 2], f32)> = world
        .query::<(&Part, &GlobalTransform)>()
        .iter(world)
        .map(|(part, pose)| {
            let half = part.half_length() * Vec3::Y;
            ([-half, half].map(|end| pose.transform_point(end)), part.radius)
        })
        .collect();
    let mut cloths = world.query::<(&ClothState, &GlobalTransform)>();
    let cloths = cloths.iter(world).flat_map(|(state, frame)| {
        let fabric = state.fabric();
        let is_free = move |particle: usize| fabric.is_some_and(|it| !it.is_pinned(particle));
        let free = state.positions().iter().enumerate().filter(move |&(at, _)| is_free(at));
        free.map(move |(_, &at)| frame.transform_point(at))
    });
    greatest(cloths.flat_map(|at| {
        capsules.iter().map(move |&([from, to], radius)| {
            let along = ((at - from).dot(to - from) / from.distance_squared(to)).clamp(0.0, 1.0);
            (radius - at.distance(from.lerp(to, along))).max(0.0)
        })
    }))
}
