//! Reports colliders that no cloth feels.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::environment::collider::ClothCollider;

/// Says that the shape of a [`ClothCollider`] on a scaled entity has its size in metres already, as
/// `ClothCollider::from_mesh` and avian's shapes have it, so that the scale does not change it.
///
/// ```
/// use bevy_bunting::ScaleInShape;
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
/// use bevy_transform::prelude::*;
///
/// // A unit ball is drawn twice as large, and touched in that size.
/// let ball = (ClothCollider::ball(2.0), ScaleInShape, Transform::from_scale(Vec3::splat(2.0)));
/// # assert_eq!(ball.1, ScaleInShape::default());
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ScaleInShape;

/// Reports numbers of colliders that cannot be, whenever they change.
pub(super) fn report_colliders(
    colliders: Query<(Entity, &ClothCollider), Changed<ClothCollider>>,
    mut commands: Commands,
) {
    for (entity, collider) in &colliders {
        if let Some((name, value)) = defect(collider) {
            ClothFailed::report(
                &mut commands,
                entity,
                ClothError::Collider { entity, name, value },
            );
        }
    }
}

/// The first number of a collider that cannot be, with its name.
fn defect(collider: &ClothCollider) -> Option<(&'static str, f32)> {
    let numbers = [("margin", collider.margin), ("friction", collider.friction)];
    if let Some(number) = numbers.into_iter().find(|(_, value)| !value.is_finite()) {
        return Some(number);
    }
    // Shapes without end have boxes without end, of which the extent is no number.
    if collider.shape.as_halfspace().is_some() {
        return None;
    }
    let bounds = collider.shape.compute_local_aabb();
    let extents = (bounds.maxs - bounds.mins).to_array();
    // True where a number is NaN.
    let bad = extents.into_iter().find(|extent| !(extent.is_finite() && *extent >= 0.0));
    bad.map(|extent| ("shape's extent", extent))
}
