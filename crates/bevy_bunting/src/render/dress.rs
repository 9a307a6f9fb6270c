//! Every cloth gets a mesh for each of its levels.

use std::collections::HashMap;
use std::sync::Arc;

use bevy_asset::{AssetId, Assets, Handle, RenderAssetUsages};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{NoAutoAabb, Visibility};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};

use super::level_mesh;
use crate::error::{ClothError, ClothFailed};
use crate::instance::ClothInstance;
use crate::levels::ClothLevels;
use crate::mesh::ClothMesh;
use crate::state::ClothState;
use crate::surface::ClothSurface;

/// The meshes that show a cloth.
#[derive(Component, Debug)]
pub struct LevelMeshes {
    /// What they were made for.
    levels: Arc<ClothLevels>,
    /// One a level, the finest first.
    meshes: Vec<Handle<Mesh>>,
    pub origin: MeshOrigin,
}

/// Where the finest mesh comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshOrigin {
    /// Made for the cloth.
    Made,
    /// The cloth came with it.
    Given,
    /// The cloth came with it, but it cannot be written.
    Refused,
}

impl LevelMeshes {
    fn contains(&self, mesh: AssetId<Mesh>) -> bool {
        self.meshes.iter().any(|own| own.id() == mesh)
    }
}

/// Makes the meshes of cloths that are new, cut anew or have another `Mesh3d`.
pub fn dress_cloths(
    cloths: Query<(Entity, &ClothMesh, &ClothInstance, Option<&Mesh3d>, Option<&LevelMeshes>)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut owners: Local<HashMap<AssetId<Mesh>, Entity>>,
    mut commands: Commands,
) {
    for (entity, shape, instance, worn, dressed) in &cloths {
        let Some(levels) = &instance.levels else { continue };
        let own = dressed.filter(|own| worn.is_some_and(|worn| own.contains(worn.id())));
        if own.is_some_and(|own| Arc::ptr_eq(&own.levels, levels)) {
            continue;
        }
        let given = match own {
            Some(own) if own.origin == MeshOrigin::Made => None,
            Some(own) => own.meshes.first(),
            None => worn.map(|worn| &worn.0),
        };
        let (finest, origin) = match given {
            None => (meshes.add(level_mesh::finest(shape, levels.fabric(0))), MeshOrigin::Made),
            Some(given) => {
                // What is not yet loaded is asked for again.
                let Some(mesh) = meshes.get(given) else { continue };
                let vertices = levels.fabric(0).particle_of_vertex().len();
                if let Err(error) = check(entity, mesh, vertices) {
                    ClothFailed::report(&mut commands, entity, error);
                    (given.clone(), MeshOrigin::Refused)
                } else {
                    owners.retain(|_, owner| cloths.contains(*owner));
                    let shared = *owners.entry(given.id()).or_insert(entity) != entity;
                    let copy = shared.then(|| mesh.clone());
                    (copy.map_or(given.clone(), |copy| meshes.add(copy)), MeshOrigin::Given)
                }
            }
        };
        let mut dress = vec![finest];
        if let (Some(grid), true) = (shape.as_grid(), origin != MeshOrigin::Refused) {
            for level in 1..levels.count() {
                let finest = meshes.get(&dress[0]).expect("it was found or made above");
                let coarser = level_mesh::coarser(finest, grid, 1 << level, levels.fabric(level));
                dress.push(meshes.add(coarser));
            }
        }
        let shown = dress.get(instance.level).unwrap_or(&dress[0]).clone();
        let mut cloth = commands.entity(entity);
        cloth.insert((
            Mesh3d(shown),
            LevelMeshes { levels: Arc::clone(levels), meshes: dress, origin },
        ));
        if origin != MeshOrigin::Refused {
            cloth.insert(NoAutoAabb).insert_if_new((
                ClothSurface::default(),
                Aabb::default(),
                Visibility::default(),
            ));
        }
    }
}

/// Whether a mesh can be written as one of so many vertices.
pub fn check(entity: Entity, mesh: &Mesh, expected: usize) -> Result<(), ClothError> {
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

/// Shows each cloth with the mesh of its level.
pub fn switch_levels(mut cloths: Query<(&ClothState, &LevelMeshes, &mut Mesh3d)>) {
    for (state, dress, mut worn) in &mut cloths {
        if let Some(mesh) = dress.meshes.get(state.level())
            && worn.0 != *mesh
            && dress.contains(worn.id())
        {
            worn.0 = mesh.clone();
        }
    }
}
