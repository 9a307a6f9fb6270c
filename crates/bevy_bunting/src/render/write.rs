//! Writes surfaces into meshes, in place.

use std::sync::Arc;

use bevy_asset::{AssetEvent, AssetId, Assets};
use bevy_camera::visibility::ViewVisibility;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bunting_solver::{Subdivision, SubdivisionBuffers};

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::state::ClothState;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::render::level_meshes::{LevelMeshes, MeshOrigin, SubdividedMesh, check_mesh};
use crate::render::subdivided_mesh;
use crate::render::tangents::TangentSums;

type WrittenCloth = (
    Entity,
    &'static ClothState,
    &'static ClothSurface,
    &'static ViewVisibility,
    &'static mut LevelMeshes,
    &'static mut Mesh3d,
);

/// Writes the meshes of cloths that were visible in the last frame, before Bevy looks for changed assets in
/// this frame.
pub fn write_visible(
    mut cloths: Query<WrittenCloth>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut buffers: Local<WriteBuffers>,
    mut commands: Commands,
) {
    for (entity, state, surface, visibility, mut level_meshes, shown) in &mut cloths {
        let to_write = ToWrite::of(entity, state, surface, visibility, &level_meshes, shown.id());
        let Some(to_write) = to_write else { continue };
        let Some(mut mesh) = meshes.get_mut(shown.id()) else { continue };
        match to_write.write(mesh.bypass_change_detection(), &mut buffers) {
            Ok(true) => {
                mesh.into_inner();
            }
            Ok(false) => {}
            Err(error) => refuse(&mut level_meshes, error, &mut commands, entity),
        }
    }
}

/// Writes the meshes of cloths that come into view in this frame. By then Bevy has looked for changed assets,
/// so this system sends the change as an event itself.
pub fn write_newly_visible(
    mut cloths: Query<WrittenCloth, Changed<ViewVisibility>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut events: MessageWriter<AssetEvent<Mesh>>,
    mut buffers: Local<WriteBuffers>,
    mut commands: Commands,
) {
    for (entity, state, surface, visibility, mut level_meshes, mut shown) in &mut cloths {
        let to_write = ToWrite::of(entity, state, surface, visibility, &level_meshes, shown.id());
        let Some(to_write) = to_write else { continue };
        let Some(mesh) = meshes.get_mut_untracked(shown.id()) else { continue };
        match to_write.write(mesh, &mut buffers) {
            Ok(true) => {
                events.write(AssetEvent::Modified { id: shown.id() });
                shown.set_changed();
            }
            Ok(false) => {}
            Err(error) => refuse(&mut level_meshes, error, &mut commands, entity),
        }
    }
}

fn refuse(
    level_meshes: &mut LevelMeshes,
    error: ClothError,
    commands: &mut Commands,
    entity: Entity,
) {
    level_meshes.origin = MeshOrigin::Refused;
    ClothFailed::report(commands, entity, error);
}

/// Buffers that are kept from frame to frame.
#[derive(Debug, Default)]
pub struct WriteBuffers {
    tangents: TangentSums,
    subdivision: SubdivisionBuffers,
}

/// A surface, and the mesh that shows it.
struct ToWrite<'a> {
    entity: Entity,
    levels: Arc<ClothLevels>,
    /// The subdivision that the mesh shows; none if it shows the particles.
    subdivided: Option<Arc<SubdividedMesh>>,
    surface: &'a ClothSurface,
    /// Whether the cloth is blended with the animated places instead of those at rest.
    is_skinned: bool,
}

impl<'a> ToWrite<'a> {
    /// That of a cloth; none if the cloth is not visible, or its surface or the mesh does not fit its levels.
    fn of(
        entity: Entity,
        state: &ClothState,
        surface: &'a ClothSurface,
        visibility: &ViewVisibility,
        level_meshes: &LevelMeshes,
        shown: AssetId<Mesh>,
    ) -> Option<Self> {
        state.fabric()?;
        let levels = &level_meshes.levels;
        let fits = surface.positions.len() == levels.fabric(surface.level()).particle_count();
        let is_own = level_meshes.origin != MeshOrigin::Refused && level_meshes.contains(shown);
        let is_written = visibility.get() && fits && is_own;
        is_written.then(|| Self {
            entity,
            levels: Arc::clone(levels),
            subdivided: level_meshes.subdivided_mesh(shown).cloned(),
            surface,
            is_skinned: state.is_skinned,
        })
    }

    /// Writes positions and normals into the mesh, and tangents if it has any. Returns whether the mesh has
    /// changed.
    fn write(&self, mesh: &mut Mesh, buffers: &mut WriteBuffers) -> Result<bool, ClothError> {
        let changed = match &self.subdivided {
            Some(subdivided) => {
                self.write_subdivided(mesh, &subdivided.subdivision, &mut buffers.subdivision)?
            }
            None => self.write_particles(mesh)?,
        };
        if changed {
            buffers.tangents.write_tangents(mesh);
        }
        Ok(changed)
    }

    fn write_particles(&self, mesh: &mut Mesh) -> Result<bool, ClothError> {
        let Self { levels, surface, .. } = self;
        let topology = levels.topology(surface.level());
        check_mesh(self.entity, mesh, topology.vertex_count())?;
        let drawn = levels.drawn(surface.level(), &surface.positions);
        let vertices = || topology.simulated.iter().zip(drawn.point_of_vertex);
        let normals = levels.drawn_normals(
            surface.level(),
            &drawn.positions,
            &surface.normals,
            !self.is_skinned,
        );
        let mut changed = false;
        for (attribute, source) in
            [(Mesh::ATTRIBUTE_POSITION, &drawn.positions), (Mesh::ATTRIBUTE_NORMAL, &normals)]
        {
            if let Ok(VertexAttributeValues::Float32x3(values)) = mesh.try_attribute_mut(attribute)
            {
                changed |= copy_to_vertices(source, vertices(), values);
            }
        }
        Ok(changed)
    }

    fn write_subdivided(
        &self,
        mesh: &mut Mesh,
        subdivision: &Subdivision,
        buffers: &mut SubdivisionBuffers,
    ) -> Result<bool, ClothError> {
        check_mesh(self.entity, mesh, subdivision.attributes().rows().len())?;
        let level = self.surface.level();
        let points = self.levels.points(level, &self.surface.positions);
        if subdivided_mesh::is_current(mesh, subdivision, &points) {
            return Ok(false);
        }
        subdivided_mesh::write(mesh, subdivision, &points.positions, buffers);
        Ok(true)
    }
}

/// Copies values of particles to vertices, given as pairs of indices. Returns whether any value has changed.
fn copy_to_vertices<'a>(
    source: &[Vec3],
    vertices: impl Iterator<Item = (&'a u32, &'a u32)>,
    values: &mut [[f32; 3]],
) -> bool {
    let mut changed = false;
    for (&vertex, &particle) in vertices {
        let (value, new) = (&mut values[vertex as usize], source[particle as usize].to_array());
        changed |= *value != new;
        *value = new;
    }
    changed
}
