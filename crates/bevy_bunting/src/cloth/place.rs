//! Where an entity is, in words for messages.

use bevy_ecs::prelude::*;

/// The file that an entity is from, the names of those above it and its own, and a colon; empty if there are none:
/// `props/flag.gltf#Mesh0/Primitive0, Scene/Pole/Flag: `.
pub(crate) fn place(world: &World, entity: Entity) -> String {
    let above = |&entity: &Entity| world.get::<ChildOf>(entity).map(ChildOf::parent);
    let line: Vec<Entity> = core::iter::successors(Some(entity), above).collect();
    let names = line.iter().rev().filter_map(|&entity| world.get::<Name>(entity));
    let names = names.map(Name::as_str).collect::<Vec<_>>().join("/");
    let file = line.iter().find_map(|&entity| file(world, entity));
    let known: Vec<String> = file.into_iter().chain([names]).filter(|it| !it.is_empty()).collect();
    if known.is_empty() { String::new() } else { known.join(", ") + ": " }
}

/// Path of the file that the entity's own mesh or scene is from.
#[cfg(feature = "render")]
fn file(world: &World, entity: Entity) -> Option<String> {
    let entity = world.get_entity(entity).ok()?;
    let source = entity.get::<crate::render::source_mesh::SourceMesh>();
    let source = source.and_then(|it| it.source().path());
    let shown = || entity.get::<bevy_mesh::Mesh3d>().and_then(|it| it.0.path());
    let path = source.or_else(shown);
    #[cfg(feature = "gltf")]
    let path = path.or_else(|| {
        entity.get::<bevy_world_serialization::WorldAssetRoot>().and_then(|it| it.0.path())
    });
    path.map(ToString::to_string)
}

#[cfg(not(feature = "render"))]
fn file(_: &World, _: Entity) -> Option<String> {
    None
}
