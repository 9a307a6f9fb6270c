//! Avian's colliders are the cloth's: added, changed and removed.

use std::sync::Arc;

use avian3d::prelude::{
    Collider, ColliderDisabled, ColliderOf, DefaultFriction, Friction, Position, Rotation, Sensor,
};
use bevy_bunting::parry3d::shape::SharedShape;
use bevy_bunting::{ClothCollider, ScaleInShape};
use bevy_ecs::prelude::*;

use crate::error::{ClothColliderError, ClothColliderFailed};
use crate::shape::collider_of;

/// The shape of an avian collider of which a [`ClothCollider`] was made, or which was refused.
#[derive(Component)]
pub(crate) struct FromAvian(SharedShape);

/// The pose of an avian collider is not finite, which was reported.
#[derive(Component)]
pub(crate) struct BadPose;

type AvianCollider = (
    Entity,
    &'static Collider,
    &'static Position,
    &'static Rotation,
    Option<&'static ColliderOf>,
    Option<&'static FromAvian>,
    Option<&'static mut ClothCollider>,
    Has<BadPose>,
);

/// Filter of the colliders that bodies collide with.
type Touches = (Without<Sensor>, Without<ColliderDisabled>);

/// Filter of entities that they do not collide with.
type TouchesNoLonger = Or<(Without<Collider>, With<Sensor>, With<ColliderDisabled>)>;

/// Makes [`ClothCollider`]s of avian's colliders that are new or have another shape, and copies their friction. A
/// `ClothCollider` of the user's is left alone.
pub(crate) fn copy_colliders(
    mut colliders: Query<AvianCollider, Touches>,
    frictions: Query<&Friction>,
    default_friction: Res<DefaultFriction>,
    mut commands: Commands,
) {
    for (entity, collider, position, rotation, of, from, cloth_collider, was_bad) in &mut colliders
    {
        if from.is_none() && cloth_collider.is_some() {
            continue;
        }
        let is_bad = !(position.is_finite() && rotation.is_finite());
        if is_bad && !was_bad {
            commands.entity(entity).insert(BadPose);
            ClothColliderFailed::report(&mut commands, entity, ClothColliderError::Pose { entity });
        } else if was_bad && !is_bad {
            commands.entity(entity).remove::<BadPose>();
        }
        if is_bad {
            continue;
        }
        let body = of.map(|of| of.body);
        let friction = [Some(entity), body].into_iter().flatten();
        let friction = friction.filter_map(|it| frictions.get(it).ok()).next();
        let friction = friction.unwrap_or(&default_friction.0).dynamic_coefficient;
        let shape = collider.shape_scaled();
        if from.is_some_and(|from| Arc::ptr_eq(&from.0.0, &shape.0)) {
            if let Some(mut known) = cloth_collider
                && known.friction != friction
            {
                known.friction = friction;
            }
            continue;
        }
        commands.entity(entity).insert(FromAvian(shape.clone()));
        match collider_of(entity, shape) {
            Ok(new) => {
                let known = cloth_collider
                    .map_or((new.margin, new.features), |known| (known.margin, known.features));
                let (margin, features) = known;
                commands
                    .entity(entity)
                    .insert((ClothCollider { margin, friction, features, ..new }, ScaleInShape));
            }
            Err(error) => {
                commands.entity(entity).remove::<(ClothCollider, ScaleInShape)>();
                ClothColliderFailed::report(&mut commands, entity, error);
            }
        }
    }
}

/// Removes the [`ClothCollider`]s of which the avian collider was removed, or does not collide any longer.
pub(crate) fn forget_colliders(
    colliders: Query<Entity, (With<FromAvian>, TouchesNoLonger)>,
    mut commands: Commands,
) {
    for entity in &colliders {
        commands.entity(entity).remove::<(FromAvian, BadPose, ClothCollider, ScaleInShape)>();
    }
}
