//! The system that makes colliders as large as the scales of their entities say.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::environment::collider::ClothCollider;
use crate::environment::report_colliders::ScaleInShape;
use crate::environment::scaled_shape::ScaledShape;
use crate::motion::pose::PoseHistory;

type ScaledCollider = (
    Entity,
    &'static ClothCollider,
    &'static PoseHistory,
    &'static mut ScaledShape,
    Has<ScaleInShape>,
);

/// Filter of colliders whose shape may have another size.
type MayBeScaled = Or<(Changed<ClothCollider>, Changed<PoseHistory>, Added<ScaleInShape>)>;

/// Gives each collider its shape in the world, and reports scales that it cannot have.
pub(super) fn scale_shapes(
    mut colliders: Query<ScaledCollider, MayBeScaled>,
    mut commands: Commands,
) {
    for (entity, collider, history, mut shape, has_scale) in &mut colliders {
        let scale = if has_scale { Vec3::ONE } else { history.scale() };
        if shape.set(&collider.shape, scale) {
            ClothFailed::report(&mut commands, entity, ClothError::ColliderScale { entity, scale });
        }
    }
}

/// A collider whose shape has its size no longer is scaled in the next tick.
pub(super) fn scale_again(
    removed: On<Remove, ScaleInShape>,
    mut colliders: Query<&mut ClothCollider>,
) {
    if let Ok(mut collider) = colliders.get_mut(removed.entity) {
        collider.set_changed();
    }
}
