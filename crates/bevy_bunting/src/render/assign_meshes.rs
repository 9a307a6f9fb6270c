//! Every cloth gets a mesh for each of its levels.

use std::collections::HashMap;
use std::sync::Arc;

use bevy_asset::{AssetId, Assets, Handle, RenderAssetUsages};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{NoAutoAabb, Visibility};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};

use super::level_mesh;
use crate::cloth::error::{ClothError, ClothFailed};
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;

/// The meshes that show a cloth.
#[derive(Component, Clone, Debug)]
pub struct LevelMeshes {
    /// The cloth that they were made for: a clone of it needs its own.
    cloth: Entity,
    /// What they were made for.
    pub levels: Arc<ClothLevels>,
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

type Cloth = (
    Entity,
    &'static ClothMesh,
    &'static ClothInstance,
    Option<&'static Mesh3d>,
    Option<&'static LevelMeshes>,
);

/// Makes the meshes of cloths that are new, cut anew or have another `Mesh3d`.
pub fn dress_cloths(
    cloths: Query<Cloth>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut owners: Local<HashMap<AssetId<Mesh>, Entity>>,
    mut commands: Commands,
) {
    for (entity, shape, instance, worn, dressed) in &cloths {
        let Some(levels) = &instance.levels else { continue };
        let own = dressed.filter(|own| worn.is_some_and(|worn| own.contains(worn.id())));
        if own.is_some_and(|own| own.cloth == entity && Arc::ptr_eq(&own.levels, levels)) {
            continue;
        }
        let given = match own {
            Some(own) if own.origin == MeshOrigin::Made => None,
            Some(own) => own.meshes.first(),
            None => worn.map(|worn| &worn.0),
        };
        let (finest, origin) = match given {
            None => (meshes.add(level_mesh::finest(shape, levels)), MeshOrigin::Made),
            Some(given) => {
                // What is not yet loaded is asked for again.
                let Some(mesh) = meshes.get(given) else { continue };
                let vertices = levels.mesh(0).vertex_count();
                match check(entity, mesh, vertices) {
                    Ok(()) => {
                        owners.retain(|_, owner| cloths.contains(*owner));
                        let owner = *owners.entry(given.id()).or_insert(entity);
                        let copy = (owner != entity).then(|| mesh.clone());
                        let finest = copy.map_or(given.clone(), |copy| meshes.add(copy));
                        (finest, MeshOrigin::Given)
                    }
                    Err(error) => {
                        ClothFailed::report(&mut commands, entity, error);
                        (given.clone(), MeshOrigin::Refused)
                    }
                }
            }
        };
        if origin == MeshOrigin::Given
            && !levels.rigid().vertices.is_empty()
            && let Some(mut mesh) = meshes.get_mut(&finest)
        {
            level_mesh::write_rigid(&mut mesh, levels, 0);
        }
        let mut all = vec![finest];
        if origin != MeshOrigin::Refused {
            add_coarser(&mut all, levels, &mut meshes);
        }
        let shown = all.get(instance.level).unwrap_or(&all[0]).clone();
        let mut cloth = commands.entity(entity);
        cloth.insert((
            Mesh3d(shown),
            LevelMeshes { cloth: entity, levels: Arc::clone(levels), meshes: all, origin },
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

/// Adds the meshes of all levels but the finest, which is there.
fn add_coarser(all: &mut Vec<Handle<Mesh>>, levels: &ClothLevels, meshes: &mut Assets<Mesh>) {
    for level in 1..levels.count() {
        let finest = meshes.get(&all[0]).expect("it was found or made before");
        let coarser = level_mesh::coarser(finest, levels, level);
        all.push(meshes.add(coarser));
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

/// Shows each cloth with the mesh of its surface.
pub fn switch_levels(mut cloths: Query<(&ClothSurface, &LevelMeshes, &mut Mesh3d)>) {
    for (surface, dress, mut worn) in &mut cloths {
        if let Some(mesh) = dress.meshes.get(surface.level())
            && worn.0 != *mesh
            && dress.contains(worn.id())
        {
            worn.0 = mesh.clone();
        }
    }
}
