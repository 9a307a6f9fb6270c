//! Whether a mesh asset has changed.

use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use bevy_asset::{AssetEvent, AssetId};
use bevy_ecs::prelude::*;
use bevy_mesh::{Indices, Mesh};

use crate::render::level_meshes::LevelMeshes;

/// The mesh assets that were added or changed since the last frame, besides those that show cloths: the plugin writes these
/// itself.
pub(super) fn changed_meshes(
    events: &mut MessageReader<AssetEvent<Mesh>>,
    shown: &Query<&LevelMeshes>,
) -> HashSet<AssetId<Mesh>> {
    let id = |event: &AssetEvent<Mesh>| match *event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(id),
        _ => None,
    };
    let mut changed: HashSet<AssetId<Mesh>> = events.read().filter_map(id).collect();
    if !changed.is_empty() {
        let is_written = |id: &AssetId<Mesh>| shown.iter().any(|meshes| meshes.contains(*id));
        changed.retain(|id| !is_written(id));
    }
    changed
}

/// A hash of all that a mesh contains, by which a change is told from an access; zero of one that cannot be read.
pub(super) fn content_of(mesh: &Mesh) -> u64 {
    let (Ok(attributes), Ok(indices)) = (mesh.try_attributes(), mesh.try_indices_option()) else {
        return 0;
    };
    let mut hash = DefaultHasher::new();
    for (attribute, values) in attributes {
        attribute.id.hash(&mut hash);
        values.get_bytes().hash(&mut hash);
    }
    match indices {
        Some(Indices::U16(indices)) => indices.hash(&mut hash),
        Some(Indices::U32(indices)) => indices.hash(&mut hash),
        None => {}
    }
    mesh.primitive_topology().hash(&mut hash);
    hash.finish()
}
