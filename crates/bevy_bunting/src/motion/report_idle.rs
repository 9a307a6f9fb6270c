//! Reports attachments that hold nothing.

use bevy_ecs::prelude::*;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;
#[cfg(feature = "render")]
use crate::render::cloth_from_mesh::ClothFromMesh;

/// Filter of entities that are no cloths, and of which none is made.
#[cfg(feature = "render")]
type IsNoCloth = (Without<ClothMesh>, Without<ClothFromMesh>);
/// Filter of entities that are no cloths.
#[cfg(not(feature = "render"))]
type IsNoCloth = Without<ClothMesh>;

/// Reports new and changed attachments of entities that are no cloths.
pub(super) fn report_idle_attachments(
    changed: Query<Entity, (Changed<Attachment>, IsNoCloth)>,
    mut commands: Commands,
) {
    for entity in &changed {
        ClothFailed::report(&mut commands, entity, ClothError::NoMesh { entity });
    }
}
