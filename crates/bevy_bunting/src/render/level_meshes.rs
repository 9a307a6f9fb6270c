//! The meshes that show a cloth, one for each of its levels.

use std::sync::Arc;

use bevy_asset::{AssetId, Handle, RenderAssetUsages};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bunting_solver::Subdivision;

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
    /// Number of times that the edges of the shown mesh are halved.
    pub halvings: u32,
    /// Subdivided meshes that have been shown.
    pub subdivided: Vec<Arc<SubdividedMesh>>,
}

/// The mesh that shows a level whose edges are halved.
#[derive(Debug)]
pub struct SubdividedMesh {
    /// The level.
    pub level: usize,
    /// Number of halvings, at least 1.
    pub halvings: u32,
    /// The smooth surface.
    pub subdivision: Arc<Subdivision>,
    /// Its mesh.
    pub mesh: Handle<Mesh>,
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
        self.meshes.iter().any(|own| own.id() == mesh) || self.subdivided_mesh(mesh).is_some()
    }

    /// The subdivided mesh of a level, if it has been made.
    pub fn subdivided(&self, level: usize, halvings: u32) -> Option<&Arc<SubdividedMesh>> {
        self.subdivided.iter().find(|it| it.level == level && it.halvings == halvings)
    }

    /// The subdivision that a mesh shows; none if it shows the particles.
    pub fn subdivided_mesh(&self, mesh: AssetId<Mesh>) -> Option<&Arc<SubdividedMesh>> {
        self.subdivided.iter().find(|it| it.mesh.id() == mesh)
    }
}

/// Shows each cloth with the mesh of its surface's level, subdivided if there is such a mesh.
pub fn show_level(mut cloths: Query<(&ClothSurface, &LevelMeshes, &mut Mesh3d)>) {
    for (surface, level_meshes, mut shown) in &mut cloths {
        let level = surface.level();
        let subdivided = level_meshes.subdivided(level, level_meshes.halvings);
        let mesh = subdivided.map(|it| &it.mesh).or_else(|| level_meshes.meshes.get(level));
        if let Some(mesh) = mesh
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
