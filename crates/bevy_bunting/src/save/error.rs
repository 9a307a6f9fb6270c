//! Reasons why a cloth cannot be saved or restored.

use bevy_ecs::prelude::*;

use crate::cloth::error::ClothError;

/// Reason why a cloth cannot be saved or restored. Nothing has changed then, of this cloth and of all others.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SnapshotError {
    /// There is no such cloth.
    #[error(
        "{entity} is no cloth: spawn it with the ClothMesh that it had when it was saved, or map it to the entity that is now in its place"
    )]
    NotACloth {
        /// The entity.
        entity: Entity,
    },
    /// The cloth has no state yet, as before its first tick and while another thread builds its fabrics; or it cannot be
    /// simulated.
    #[error(
        "cloth {entity} has no state to be saved: wait until its ClothState has positions, or look for a ClothFailed event that tells why it has none"
    )]
    NotSimulated {
        /// The cloth.
        entity: Entity,
    },
    /// What the cloth is made of has changed since its last tick, so that its state is not that of its components.
    #[error(
        "the ClothMesh, Attachment, ClothResolution, ClothRegions or LodSet of cloth {entity} has changed since the last tick: save it after the next tick"
    )]
    Unsettled {
        /// The cloth.
        entity: Entity,
    },
    /// The snapshot is one of a cloth of other particles, levels, anchors or joints.
    #[error(
        "the snapshot is one of another cloth than {entity}: give that the ClothMesh, Attachment, ClothResolution, ClothRegions, LodSet, ClothSkin and scale that the saved cloth had, before it is restored"
    )]
    OtherCloth {
        /// The cloth that was to be restored.
        entity: Entity,
    },
    /// A number in the snapshot is not finite, or not possible.
    #[error(
        "the snapshot of cloth {entity} holds numbers that cannot be simulated: take an older one, or let the cloth start anew"
    )]
    NotFinite {
        /// The cloth.
        entity: Entity,
    },
    /// The cloth that is to be restored cannot be simulated.
    #[error(transparent)]
    Cloth(#[from] ClothError),
}
