//! Reasons why an avian collider is none for cloth.

use bevy_bunting::ColliderError;
use bevy_bunting::parry3d::shape::ShapeType;
use bevy_ecs::prelude::*;

/// Reason why cloth does not touch an avian collider; the message says what to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ClothColliderError {
    /// A shape without a surface, or one that parry does not know. No cloth touches it until the `Collider` changes.
    #[error(
        "cloth cannot touch the avian collider of {entity}, a {shape:?}: give it a shape with a surface, or a ClothCollider of its own"
    )]
    Shape {
        /// The collider.
        entity: Entity,
        /// Kind of the shape.
        shape: ShapeType,
    },
    /// A mesh of triangles that cannot be a collider of cloth. No cloth touches it until the `Collider` changes.
    #[error("cloth cannot touch the avian collider of {entity}: {source}")]
    Mesh {
        /// The collider.
        entity: Entity,
        /// Defect of the mesh.
        source: ColliderError,
    },
    /// A size or a scale of the shape is not finite. No cloth touches it until the `Collider` changes.
    #[error(
        "the avian collider of {entity} has a size or a scale that is not finite: check what writes them"
    )]
    Size {
        /// The collider.
        entity: Entity,
    },
    /// The collider's pose is not finite. It stays at its last finite pose; a new collider is not touched before it has
    /// one.
    #[error("the pose of the avian collider of {entity} is not finite: check what moves it")]
    Pose {
        /// The collider.
        entity: Entity,
    },
}

/// Cloth does not touch an avian collider as asked. Triggered on the collider and logged once, when the error is found.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothColliderFailed {
    /// The collider.
    pub entity: Entity,
    /// The reason; its message says what to do.
    pub error: ClothColliderError,
}

impl ClothColliderFailed {
    /// Logs the error and triggers the event.
    pub(crate) fn report(commands: &mut Commands, entity: Entity, error: ClothColliderError) {
        log::error!("{error}");
        commands.trigger(Self { entity, error });
    }
}
