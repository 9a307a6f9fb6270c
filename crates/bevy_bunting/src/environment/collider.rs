//! What a cloth may touch.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;
use bunting_solver::Collider;
use parry3d::math::Vector;
use parry3d::shape::SharedShape;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::reflect::SharedShapeReflect;
use crate::environment::drive::{drive_cloths, pose_parts};
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// A shape that no cloth can enter. It moves with its entity, pushes cloth and is not pushed.
#[derive(Component, Clone, Reflect)]
#[reflect(Component, Clone)]
#[require(Transform, PoseHistory)]
pub struct ClothCollider {
    /// The shape in the entity's frame, m; the entity's scale is ignored.
    #[reflect(remote = SharedShapeReflect)]
    pub shape: SharedShape,
    /// Distance that cloth keeps in addition to its thickness, m. It rounds edges: a box with a
    /// margin is a round box, and cheaper than parry's, whose nearest points are searched for.
    pub margin: f32,
    /// Coulomb friction coefficient; the cloth's own is multiplied by it and the root taken.
    pub friction: f32,
}

impl ClothCollider {
    /// Any parry shape, without a margin, with a friction coefficient of 1: the cloth's counts.
    #[must_use]
    pub const fn new(shape: SharedShape) -> Self {
        Self { shape, margin: 0.0, friction: 1.0 }
    }

    /// A ball of a radius in metres.
    #[must_use]
    pub fn ball(radius: f32) -> Self {
        Self::new(SharedShape::ball(radius))
    }

    /// A capsule along y: half the length of its axis, and its radius, m.
    #[must_use]
    pub fn capsule(half_height: f32, radius: f32) -> Self {
        Self::new(SharedShape::capsule_y(half_height, radius))
    }

    /// A box of half extents in metres.
    #[must_use]
    pub fn cuboid(half_extents: Vec3) -> Self {
        Self::new(SharedShape::cuboid(half_extents.x, half_extents.y, half_extents.z))
    }

    /// Everything below the entity's xz plane.
    #[must_use]
    pub fn ground() -> Self {
        Self::new(SharedShape::halfspace(Vector::Y))
    }
}

/// Shows the [`ClothCollider`]s to the cloths.
#[derive(Debug, Default)]
pub struct ColliderPlugin;

impl Plugin for ColliderPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothCollider>().register_type::<SharedShapeReflect>().add_systems(
            ClothTick,
            drive_colliders.in_set(ClothSystems::Drive).after(drive_cloths),
        );
    }
}

/// Gives each cloth every collider, in the cloth's frame: as it stood then at the start of the
/// tick, as it stands now at the end. What is moved in frames is extrapolated to the time of the tick: cloth
/// and colliders alike, so that those that ride along rest.
fn drive_colliders(
    colliders: Query<(&ClothCollider, &PoseHistory)>,
    cloths: Query<(&ClothInstance, &PoseHistory)>,
    mut batches: ResMut<ClothBatches>,
    mut were_any: Local<bool>,
) {
    let are_any = !colliders.is_empty();
    if !are_any && !*were_any {
        return;
    }
    *were_any = are_any;
    for (instance, frame) in &cloths {
        let Some(slot) = instance.slot() else { continue };
        let (start, end) = frame.ahead();
        let (start, end) = (start.inverse(), end.inverse());
        let seen = colliders.iter().map(|(collider, pose)| {
            let (from, to) = pose.ahead();
            Collider {
                shape: collider.shape.clone(),
                from: seen_from(start, from),
                to: seen_from(end, to),
                margin: collider.margin,
                friction: collider.friction,
            }
        });
        batches.lane(slot).set_colliders(seen);
    }
}

fn seen_from(inverse_frame: Isometry3d, pose: Isometry3d) -> (Vec3, Quat) {
    let (translation, rotation) = pose_parts(inverse_frame * pose);
    (translation, rotation.normalize())
}
