//! Writes surfaces into meshes, in place.

use std::sync::Arc;

use bevy_asset::{AssetEvent, Assets};
use bevy_camera::visibility::ViewVisibility;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};

use super::assign_meshes::{LevelMeshes, MeshOrigin, check};
use super::tangents::TangentScratch;
use crate::cloth::error::{ClothError, ClothFailed};
use crate::cloth::state::ClothState;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;

type Shown = (
    Entity,
    &'static ClothState,
    &'static ClothSurface,
    &'static ViewVisibility,
    &'static mut LevelMeshes,
    &'static mut Mesh3d,
);

/// Writes the meshes of cloths that were visible in the last frame, in time for Bevy to note it.
pub fn write_visible(
    mut cloths: Query<Shown>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut scratch: Local<TangentScratch>,
    mut commands: Commands,
) {
    for (entity, state, surface, visibility, mut dress, worn) in &mut cloths {
        let Some(levels) = shows(state, surface, visibility, &dress) else { continue };
        let Some(mut mesh) = meshes.get_mut(worn.id()) else { continue };
        match write(entity, mesh.bypass_change_detection(), &levels, surface, &mut scratch) {
            Ok(true) => {
                mesh.into_inner();
            }
            Ok(false) => {}
            Err(error) => refuse(&mut dress, error, &mut commands, entity),
        }
    }
}

/// Writes the meshes of cloths that come into view in this frame. Bevy has looked for changed
/// assets by then, and is told here.
pub fn write_revealed(
    mut cloths: Query<Shown, Changed<ViewVisibility>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut events: MessageWriter<AssetEvent<Mesh>>,
    mut scratch: Local<TangentScratch>,
    mut commands: Commands,
) {
    for (entity, state, surface, visibility, mut dress, mut worn) in &mut cloths {
        let Some(levels) = shows(state, surface, visibility, &dress) else { continue };
        let Some(mesh) = meshes.get_mut_untracked(worn.id()) else { continue };
        match write(entity, mesh, &levels, surface, &mut scratch) {
            Ok(true) => {
                events.write(AssetEvent::Modified { id: worn.id() });
                worn.set_changed();
            }
            Ok(false) => {}
            Err(error) => refuse(&mut dress, error, &mut commands, entity),
        }
    }
}

/// The levels of a cloth that is to be seen, with a surface and a mesh that fit.
fn shows(
    state: &ClothState,
    surface: &ClothSurface,
    visibility: &ViewVisibility,
    dress: &LevelMeshes,
) -> Option<Arc<ClothLevels>> {
    state.fabric()?;
    let fits = surface.positions.len() == dress.levels.fabric(surface.level()).particle_count();
    let shows = visibility.get() && fits && dress.origin != MeshOrigin::Refused;
    shows.then(|| Arc::clone(&dress.levels))
}

fn refuse(dress: &mut LevelMeshes, error: ClothError, commands: &mut Commands, entity: Entity) {
    dress.origin = MeshOrigin::Refused;
    ClothFailed::report(commands, entity, error);
}

/// Writes a surface into a mesh. Whether the mesh has changed.
fn write(
    entity: Entity,
    mesh: &mut Mesh,
    levels: &ClothLevels,
    surface: &ClothSurface,
    scratch: &mut TangentScratch,
) -> Result<bool, ClothError> {
    let (fabric, parts) = (levels.fabric(surface.level()), levels.mesh(surface.level()));
    check(entity, mesh, parts.vertex_count())?;
    let places = || parts.simulated.iter().zip(fabric.particle_of_vertex());
    let mut changed = false;
    for (attribute, source) in
        [(Mesh::ATTRIBUTE_POSITION, &surface.positions), (Mesh::ATTRIBUTE_NORMAL, &surface.normals)]
    {
        if let Ok(VertexAttributeValues::Float32x3(values)) = mesh.try_attribute_mut(attribute) {
            changed |= spread(source, places(), values);
        }
    }
    if changed {
        scratch.write_tangents(mesh);
    }
    Ok(changed)
}

/// Gives each vertex the value of its particle. Whether any has changed.
fn spread<'a>(
    source: &[Vec3],
    places: impl Iterator<Item = (&'a u32, &'a u32)>,
    values: &mut [[f32; 3]],
) -> bool {
    let mut changed = false;
    for (&place, &particle) in places {
        let (value, new) = (&mut values[place as usize], source[particle as usize].to_array());
        changed |= *value != new;
        *value = new;
    }
    changed
}
