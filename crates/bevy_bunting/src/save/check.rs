//! Whether a snapshot is one of a cloth, before anything is changed.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Mat3;

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::fabric::at_once::levels_at_once;
use crate::fabric::levels::ClothLevels;
use crate::motion::attachment::Attachment;
use crate::save::cloth::SavedCloth;
use crate::save::error::SnapshotError;
use crate::save::take::{News, present_levels};
use crate::skeleton::skin::ClothSkin;

/// A cloth that a snapshot fits, and its levels.
#[derive(Debug)]
pub(super) struct Fitting {
    pub entity: Entity,
    pub levels: Arc<ClothLevels>,
    pub scale: Mat3,
}

/// Finds the levels of a cloth, which are built now if they are not there, and checks that the snapshot fits them.
///
/// # Errors
///
/// The entity is no cloth, cannot be simulated, or is another cloth than that which was saved; or the snapshot has numbers
/// that cannot be simulated.
pub(super) fn check(
    world: &mut World,
    entity: Entity,
    saved: &SavedCloth,
) -> Result<Fitting, SnapshotError> {
    let not_a_cloth = SnapshotError::NotACloth { entity };
    let cloth = world.get_entity(entity).map_err(|_| not_a_cloth)?;
    if !cloth.contains::<ClothMesh>() || !cloth.contains::<ClothInstance>() {
        return Err(not_a_cloth);
    }
    let (levels, scale) = match known_levels(world, cloth, saved) {
        Some(known) => known,
        None => levels_at_once(world, entity, saved.growth.end())?.ok_or(not_a_cloth)?,
    };
    let cloth = world.entity(entity);
    let anchors = cloth.get::<Attachment>().map_or(0, |attachment| attachment.anchors.len());
    let joints = cloth.get::<ClothSkin>().map(|skin| skin.joints.len());
    if !is_of(saved, &levels) || anchors != saved.anchors.len() || !has_joints(saved, joints) {
        return Err(SnapshotError::OtherCloth { entity });
    }
    let is_good = saved.state.is_finite()
        && saved.material.validate().is_ok()
        && saved.effort.settings.substeps > 0
        && saved.effort.settings.passes > 0;
    if !is_good {
        return Err(SnapshotError::NotFinite { entity });
    }
    Ok(Fitting { entity, levels, scale })
}

/// The levels that a cloth has, unless the next tick looks for others.
fn known_levels(
    world: &World,
    cloth: EntityRef,
    saved: &SavedCloth,
) -> Option<(Arc<ClothLevels>, Mat3)> {
    let (levels, instance) = present_levels(&News::of(world)?, cloth)?;
    is_of(saved, levels).then(|| (Arc::clone(levels), instance.scale))
}

/// Whether a snapshot is one of a cloth with these levels.
fn is_of(saved: &SavedCloth, levels: &ClothLevels) -> bool {
    let is_same = || {
        let kept =
            saved.levels.as_ref().is_some_and(|kept| core::ptr::eq(&raw const **kept, levels));
        kept || saved.fingerprint == levels.fingerprint(saved.level)
    };
    saved.level_count == levels.count()
        && saved.level < levels.count()
        && is_same()
        && saved.state.is_of(levels.fabric(saved.level).particle_count())
        && saved.surface.is_of(levels)
}

/// Whether a snapshot is one of a cloth with a skin of so many joints, or without one.
fn has_joints(saved: &SavedCloth, joints: Option<usize>) -> bool {
    let Some(skin) = &saved.skin else { return true };
    let matrices = skin.matrices.as_ref().map_or(skin.joints.len(), Vec::len);
    joints == Some(skin.joints.len()) && joints == Some(matrices)
}
