//! Colliders: shapes that cloth does not enter.

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

/// A shape that no cloth enters. It moves with its entity and pushes cloth; cloth does not push it. A
/// heightfield is solid below its surface.
#[derive(Component, Clone, Reflect)]
#[reflect(Component, Clone)]
#[require(Transform, PoseHistory)]
pub struct ClothCollider {
    /// The shape in the entity's frame, m; the entity's scale is ignored.
    #[reflect(remote = SharedShapeReflect)]
    pub shape: SharedShape,
    /// Distance that cloth keeps from the shape in addition to its thickness, m. A margin rounds edges: a box
    /// with a margin is a round box, and cheaper than parry's round cuboid, whose projections are iterative.
    pub margin: f32,
    /// Coulomb friction coefficient. A contact uses the geometric mean of this value and the material's.
    pub friction: f32,
}

impl ClothCollider {
    /// A collider of any parry shape, without a margin, with a friction coefficient of 1.
    #[must_use]
    pub const fn new(shape: SharedShape) -> Self {
        Self { shape, margin: 0.0, friction: 1.0 }
    }

    /// A ball of the given radius (m).
    #[must_use]
    pub fn ball(radius: f32) -> Self {
        Self::new(SharedShape::ball(radius))
    }

    /// A capsule along y with the given half length of its axis (m) and radius (m).
    #[must_use]
    pub fn capsule(half_height: f32, radius: f32) -> Self {
        Self::new(SharedShape::capsule_y(half_height, radius))
    }

    /// A box of the given half extents (m).
    #[must_use]
    pub fn cuboid(half_extents: Vec3) -> Self {
        Self::new(SharedShape::cuboid(half_extents.x, half_extents.y, half_extents.z))
    }

    /// The half space below the entity's xz plane.
    #[must_use]
    pub fn ground() -> Self {
        Self::new(SharedShape::halfspace(Vector::Y))
    }
}

/// Gives each cloth the [`ClothCollider`]s that it may touch.
#[derive(Debug, Default)]
pub struct ColliderPlugin;

impl Plugin for ColliderPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothCollider>().register_type::<SharedShapeReflect>().add_systems(
            ClothTick,
            (
                report_bad_colliders.in_set(ClothSystems::Prepare),
                drive_colliders.in_set(ClothSystems::Drive).after(drive_cloths),
            ),
        );
    }
}

/// Reports new and changed colliders with numbers that the solver refuses.
fn report_bad_colliders(colliders: Query<(Entity, &ClothCollider), Changed<ClothCollider>>) {
    for (entity, collider) in &colliders {
        let ClothCollider { margin, friction, .. } = *collider;
        if !margin.is_finite() || !friction.is_finite() {
            log::error!(
                "the ClothCollider of {entity} has a margin of {margin} m and a friction of {friction}: no cloth \
                 feels it until both are finite"
            );
        }
    }
}

/// Sets the colliders of each cloth, relative to the cloth's frame: their poses at the start of the tick
/// relative to the frame at that time, and their poses at its end likewise. Poses of entities that move in
/// frames are extrapolated to the time of the tick, of cloths and colliders alike, so that a collider that
/// moves with a cloth rests in its frame.
fn drive_colliders(
    colliders: Query<(&ClothCollider, &PoseHistory)>,
    cloths: Query<(&ClothInstance, &PoseHistory)>,
    mut batches: ResMut<ClothBatches>,
    mut had_any: Local<bool>,
) {
    let has_any = !colliders.is_empty();
    if !has_any && !*had_any {
        return;
    }
    *had_any = has_any;
    for (instance, frame) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        let (start, end) = frame.extrapolated();
        let (start, end) = (start.inverse(), end.inverse());
        let colliders = colliders.iter().map(|(collider, pose)| {
            let (from, to) = pose.extrapolated();
            Collider {
                shape: collider.shape.clone(),
                from: relative_pose(start, from),
                to: relative_pose(end, to),
                margin: collider.margin,
                friction: collider.friction,
            }
        });
        batches.lane(lane).set_colliders(colliders);
    }
}

/// A pose relative to a frame, given the inverse of the frame's pose.
fn relative_pose(inverse_frame: Isometry3d, pose: Isometry3d) -> (Vec3, Quat) {
    let (translation, rotation) = pose_parts(inverse_frame * pose);
    (translation, rotation.normalize())
}
