//! Reports colliders that no cloth feels, or feels in another size than they seem to have.

use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::environment::collider::ClothCollider;

/// Part by which a scale may differ from 1 without a message. Smaller: rounding in turned hierarchies is taken for a scale.
/// Larger: colliders are of another size than what is drawn.
const TOLERANCE: f32 = 1e-3;

/// Says that the shape of a [`ClothCollider`] on a scaled entity has its size in metres already, as
/// `ClothCollider::from_mesh` and avian's shapes have it, so that the scale is not reported as
/// [`ClothError::ColliderScale`]. It changes nothing else.
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

/// Filter of colliders whose scale may be another than before.
type MayBeScaled = (Or<(Changed<ClothCollider>, Changed<Transform>)>, Without<ScaleInShape>);

/// Reports scales of the entities of colliders, once until they have none.
pub(super) fn report_scales(
    colliders: Query<(Entity, Ref<ClothCollider>, &Transform), MayBeScaled>,
    transforms: TransformHelper,
    mut removed: RemovedComponents<ClothCollider>,
    mut reported: Local<EntityHashSet>,
    mut commands: Commands,
) {
    for entity in removed.read() {
        reported.remove(&entity);
    }
    for (entity, collider, own) in &colliders {
        // The scales above it count when the collider is new: what moves in each tick is only compared.
        let scale = match collider.is_changed() {
            true => transforms.compute_global_transform(entity).map_or(own.scale, |it| it.scale()),
            false => own.scale,
        };
        if scale.abs_diff_eq(Vec3::ONE, TOLERANCE) {
            reported.remove(&entity);
        } else if reported.insert(entity) {
            ClothFailed::report(&mut commands, entity, ClothError::ColliderScale { entity, scale });
        }
    }
}
