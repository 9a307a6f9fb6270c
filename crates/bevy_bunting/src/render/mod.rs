//! Cloth to look at: meshes, bounds, levels of detail by camera, gizmos.

mod assign_meshes;
mod bounds;
mod camera_lens;
mod debug;
mod from_mesh;
mod hidden;
mod level_mesh;
mod tangents;
mod write;

use bevy_app::{App, Plugin, PostUpdate, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_asset::{AssetEventSystems, Assets};
use bevy_camera::Camera3d;
use bevy_camera::visibility::VisibilitySystems;
use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;

use crate::lod::{LodViewer, choose_levels};
use crate::schedule::{ClothSystems, ClothTick};

pub use debug::{ClothDebugPlugin, ClothGizmos};
pub(crate) use level_mesh::LevelMesh;

/// What happens in `PostUpdate` to show cloth. To change what is shown, change
/// [`ClothSurface`](crate::ClothSurface)s before.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothRenderSystems {
    /// Cloths get their meshes and take the one of their level; bounds are written, and the meshes
    /// of cloths that were visible in the last frame. Before `AssetEventSystems`.
    Drape,
    /// Meshes are written of cloths that come into view. After `VisibilitySystems`.
    Reveal,
}

/// Shows each cloth with its `Mesh3d`; does nothing in an app without `Assets<Mesh>`.
///
/// # Meshes
///
/// A cloth without a `Mesh3d` gets one: positions, normals and, if its
/// [`ClothMesh`](crate::ClothMesh) has them, texture coordinates. A mesh that the cloth comes with
/// must have the vertices of the [`ClothMesh`](crate::ClothMesh), in its order; it is written in
/// place: positions, normals and, where it has them, tangents. Of several cloths with one mesh
/// every further one gets a copy. Coarser levels take their other attributes from the finest. A
/// mesh that cannot be written is reported in a [`ClothFailed`](crate::ClothFailed) event and left
/// alone until another takes its place.
///
/// What is rigid, of weight 0, is written when a cloth gets its meshes, and not again.
///
/// Meshes are made when a cloth is new. After that no frame allocates, but for cloths that change
/// their level, whose surface is eased with the mesh of the finer level; and only cloths that are visible, to a camera or to a light, and move are written. Their `Aabb`
/// is kept right whether they are visible or not.
///
/// # Materials
///
/// Cloth has one layer of triangles for both of its faces. Give it a material with
/// `double_sided: true`, so that the back is lit by the normals of the back, and `cull_mode: None`,
/// so that it is drawn at all and casts a shadow; Bevy asks for both. `diffuse_transmission` lets
/// light through thin cloth.
///
/// Bevy 0.19 turns normals to the back only where neither the mesh has tangents nor the material a
/// normal map, or both do: have both or neither.
///
/// # Levels of detail
///
/// Every `Camera3d` becomes a [`LodViewer`] when it is spawned, which is kept like its projection and
/// its picture. Remove it from cameras that levels should not look to.
#[derive(Debug, Default)]
pub struct ClothRenderPlugin;

impl Plugin for ClothRenderPlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(view_levels)
            .add_systems(
                RunFixedMainLoop,
                camera_lens::view_through_cameras
                    .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                ClothTick,
                hidden::hide_cloths.in_set(ClothSystems::SelectLod).before(choose_levels),
            )
            .configure_sets(
                PostUpdate,
                (
                    ClothRenderSystems::Drape
                        .before(AssetEventSystems)
                        .before(VisibilitySystems::VisibilityPropagate),
                    ClothRenderSystems::Reveal
                        .after(VisibilitySystems::MarkNewlyHiddenEntitiesInvisible),
                )
                    .run_if(resource_exists::<Assets<Mesh>>),
            )
            .add_systems(
                PostUpdate,
                (
                    (
                        assign_meshes::dress_cloths,
                        assign_meshes::switch_levels,
                        bounds::bound_cloths,
                        write::write_visible,
                    )
                        .chain()
                        .in_set(ClothRenderSystems::Drape),
                    write::write_revealed.in_set(ClothRenderSystems::Reveal),
                ),
            );
    }
}

fn view_levels(added: On<Add, Camera3d>, mut commands: Commands) {
    commands.entity(added.entity).try_insert_if_new(LodViewer::default());
}

#[cfg(test)]
mod tests;
