//! Assigns meshes to cloths: one for each level, made by the plugin or given by the user.

use std::collections::HashMap;
use std::sync::Arc;

use bevy_asset::{AssetId, Assets, Handle};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{NoAutoAabb, Visibility};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d};

use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::render::deformer::ClothDeformer;
use crate::render::level_mesh;
use crate::render::level_meshes::{LevelMeshes, MeshOrigin, check_mesh};
use crate::render::source_mesh::SourceMesh;
use crate::render::subdivision::ClothSubdivision;

type ShownCloth = (
    Entity,
    &'static ClothMesh,
    &'static ClothInstance,
    Option<&'static Mesh3d>,
    Option<&'static LevelMeshes>,
    Option<&'static SourceMesh>,
);

/// The first cloth that uses each given mesh; any further cloth gets a copy of the mesh.
type Owners = HashMap<AssetId<Mesh>, Entity>;

/// Assigns meshes to cloths that are new, have rebuilt levels, or have another `Mesh3d`. Cloths that carry their meshes
/// have none of their levels.
pub fn assign_meshes(
    cloths: Query<ShownCloth, Without<ClothDeformer>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut owners: Local<Owners>,
    mut commands: Commands,
) {
    for (entity, shape, instance, shown, level_meshes, source) in &cloths {
        let Some(levels) = &instance.levels else { continue };
        let own = level_meshes.filter(|own| shown.is_some_and(|it| own.contains(it.id())));
        if own.is_some_and(|own| own.cloth == entity && Arc::ptr_eq(&own.levels, levels)) {
            continue;
        }
        let is_new = |source: &SourceMesh| shown.is_some_and(|shown| !source.shows(shown.id()));
        if own.is_none() && source.is_some_and(is_new) {
            // Another mesh of which a cloth is to be made.
            continue;
        }
        let given = match own {
            Some(own) if own.origin == MeshOrigin::Made => None,
            Some(own) => own.meshes.first(),
            None => shown.map(|shown| &shown.0),
        };
        let (finest, origin) = match given {
            None => (meshes.add(level_mesh::finest(shape, levels)), MeshOrigin::Made),
            Some(given) => {
                owners.retain(|_, owner| cloths.contains(*owner));
                let accepted =
                    accept_given(entity, given, levels, &mut meshes, &mut owners, &mut commands);
                // A mesh that is not loaded yet is tried again in the next frame.
                let Some(accepted) = accepted else { continue };
                accepted
            }
        };
        let mut all = vec![finest];
        if origin != MeshOrigin::Refused {
            add_coarser(&mut all, levels, &mut meshes);
        }
        let level_mesh = all.get(instance.level).unwrap_or(&all[0]).clone();
        let mut cloth = commands.entity(entity);
        cloth.insert((
            Mesh3d(level_mesh),
            LevelMeshes {
                cloth: entity,
                levels: Arc::clone(levels),
                meshes: all,
                origin,
                halvings: 0,
                subdivided: Vec::new(),
            },
        ));
        if origin != MeshOrigin::Refused {
            cloth.insert(NoAutoAabb).insert_if_new((
                ClothSurface::default(),
                ClothSubdivision::default(),
                Aabb::default(),
                Visibility::default(),
            ));
        }
    }
}

/// Accepts a given mesh as the finest one, or a copy of the mesh if another cloth uses it, and writes the
/// rigid vertices. A mesh that cannot be written is reported and refused. None if the mesh is not loaded yet.
fn accept_given(
    entity: Entity,
    given: &Handle<Mesh>,
    levels: &ClothLevels,
    meshes: &mut Assets<Mesh>,
    owners: &mut Owners,
    commands: &mut Commands,
) -> Option<(Handle<Mesh>, MeshOrigin)> {
    let mesh = meshes.get(given)?;
    if let Err(error) = check_mesh(entity, mesh, levels.topology(0).vertex_count()) {
        ClothFailed::report(commands, entity, error);
        return Some((given.clone(), MeshOrigin::Refused));
    }
    let owner = *owners.entry(given.id()).or_insert(entity);
    let copy = (owner != entity).then(|| mesh.clone());
    let finest = copy.map_or(given.clone(), |copy| meshes.add(copy));
    if !levels.rigid().vertices.is_empty()
        && let Some(mut mesh) = meshes.get_mut(&finest)
    {
        level_mesh::write_rigid(&mut mesh, levels, 0);
    }
    Some((finest, MeshOrigin::Given))
}

/// Appends the meshes of all coarser levels to a list that holds the finest mesh.
fn add_coarser(all: &mut Vec<Handle<Mesh>>, levels: &ClothLevels, meshes: &mut Assets<Mesh>) {
    for level in 1..levels.count() {
        let finest = meshes.get(&all[0]).expect("it was found or made before");
        let coarser = level_mesh::coarser(finest, levels, level);
        all.push(meshes.add(coarser));
    }
}
