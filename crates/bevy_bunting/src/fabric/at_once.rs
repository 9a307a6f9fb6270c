//! Levels of a cloth that are needed before the next tick.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::Mat3;
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::regions::ClothRegions;
use crate::cloth::resolution::ClothResolution;
use crate::fabric::attached::Attached;
use crate::fabric::levels::ClothLevels;
use crate::fabric::library::{FabricLibrary, Found};
use crate::fabric::scale::{ScaleBaked, bake, scale_of};
use crate::lod::lod_set::LodSet;
use crate::motion::attachment::Attachment;
use crate::skeleton::skin::ClothSkin;

type Cut = (
    &'static ClothMesh,
    Option<&'static Attachment>,
    &'static LodSet,
    Option<&'static ClothResolution>,
    Option<&'static ClothRegions>,
    Has<ScaleBaked>,
    Has<ClothSkin>,
);

/// The levels of a cloth that is `size` times as large as they are, by its present components, and the scale that is baked into them. They
/// are looked up, or built on this thread; the cloth itself does not change. None if the entity is no cloth.
///
/// # Errors
///
/// The cloth cannot be simulated.
pub(crate) fn levels_at_once(
    world: &mut World,
    entity: Entity,
    size: f32,
) -> Result<Option<(Arc<ClothLevels>, Mat3)>, ClothError> {
    let mut state = SystemState::<(Query<Cut>, TransformHelper, ResMut<FabricLibrary>)>::new(world);
    let Ok((cloths, transforms, mut library)) = state.get_mut(world) else { return Ok(None) };
    let found = cloths.get(entity);
    let Ok((mesh, attachment, lods, resolution, regions, has_baked, has_skin)) = found else {
        return Ok(None);
    };
    lods.validate(entity)?;
    let scale = scale_of(entity, attachment, has_baked || has_skin, size, &transforms)?;
    let attached = attachment.map(|attachment| Attached::of(attachment, mesh));
    let mesh = bake(mesh, scale);
    let resolution = resolution.copied().unwrap_or_default();
    let regions = regions.map_or(&[][..], |regions| &regions.0);
    library.at_once = true;
    let found = library.levels(entity, &mesh, attached, lods, (resolution, regions));
    library.at_once = false;
    Ok(if let Found::Levels(levels) = found? { Some((levels, scale)) } else { None })
}
