//! The meshes that show a cloth, one for each of its levels.

use std::sync::Arc;

use bevy_asset::{AssetId, Handle, RenderAssetUsages};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};

use crate::cloth::error::ClothError;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;

/// The meshes that show a cloth.
#[derive(Component, Clone, Debug)]
pub struct LevelMeshes {
    /// The cloth that the meshes were made for: a clone of the cloth needs its own meshes.
    pub cloth: Entity,
    /// The levels that the meshes were made for.
    pub levels: Arc<ClothLevels>,
    /// One mesh for each level, the finest first; if the finest one is refused, only this one.
    pub meshes: Vec<Handle<Mesh>>,
    /// Origin of the finest mesh.
    pub origin: MeshOrigin,
}

/// Origin of the finest mesh of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshOrigin {
    /// This plugin made it.
    Made,
    /// The user gave it as the cloth's `Mesh3d`.
    Given,
    /// The user gave it, but it cannot be written.
    Refused,
}

impl LevelMeshes {
    /// Whether a mesh is one of these meshes.
    pub fn contains(&self, mesh: AssetId<Mesh>) -> bool {
        self.meshes.iter().any(|own| own.id() == mesh)
    }
}

/// Shows each cloth with the mesh of its surface's level.
pub fn show_level(mut cloths: Query<(&ClothSurface, &LevelMeshes, &mut Mesh3d)>) {
    for (surface, level_meshes, mut shown) in &mut cloths {
        if let Some(mesh) = level_meshes.meshes.get(surface.level())
            && shown.0 != *mesh
            && level_meshes.contains(shown.id())
        {
            shown.0 = mesh.clone();
        }
    }
}

/// Checks that a mesh can be written, and has an expected number of vertices.
///
/// # Errors
///
/// The mesh is not kept in the main world, or has another number of vertices.
pub fn check_mesh(entity: Entity, mesh: &Mesh, expected: usize) -> Result<(), ClothError> {
    if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
        return Err(ClothError::MeshUnwritable { entity });
    }
    let given = match mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION) {
        Ok(positions) => positions.map_or(0, VertexAttributeValues::len),
        Err(_) => return Err(ClothError::MeshUnwritable { entity }),
    };
    if given == expected {
        Ok(())
    } else {
        Err(ClothError::MeshVertices { entity, given, expected })
    }
}
