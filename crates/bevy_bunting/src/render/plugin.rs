//! The plugin that shows cloth with meshes.

use bevy_app::{App, Plugin, PostUpdate, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_asset::{AssetEventSystems, Assets};
use bevy_camera::visibility::VisibilitySystems;
use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_transform::TransformSystems;

use crate::fabric::release::is_due;
use crate::lod::select::select_levels;
use crate::lod::sleep::wake_cloths;
use crate::render::assign_meshes::assign_meshes;
use crate::render::bounds::bound_cloths;
use crate::render::camera_lens::{add_viewer, follow_cameras};
use crate::render::cloth_from_mesh::ClothFromMesh;
use crate::render::deformer::{ClothDeformer, bind_meshes, carry_meshes};
use crate::render::hidden::hide_cloths;
use crate::render::level_meshes::show_level;
use crate::render::make_cloths::make_cloths;
use crate::render::subdivide::subdivide_cloths;
use crate::render::subdivision::ClothSubdivision;
use crate::render::subdivisions::{Subdivisions, forget_subdivisions};
use crate::render::write::{write_newly_visible, write_visible};
use crate::schedule::{ClothSystems, ClothTick};

/// The sets in `PostUpdate` that show cloth. Systems that change [`ClothSurface`](crate::ClothSurface)s, and
/// so the shown shape, must run before them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothRenderSystems {
    /// Assigns meshes to new cloths, shows each cloth with the mesh of its level, computes bounds, and writes
    /// the meshes of cloths that were visible in the last frame. Runs after `TransformSystems::Propagate` and before
    /// `AssetEventSystems`.
    UpdateMeshes,
    /// Writes the meshes of cloths that come into view in this frame. Runs after `VisibilitySystems`.
    WriteNewlyVisible,
}

/// Shows each cloth with its `Mesh3d`; does nothing in an app without `Assets<Mesh>`.
///
/// # Meshes
///
/// A cloth without a `Mesh3d` gets a mesh with positions, normals and, if its [`ClothMesh`](crate::ClothMesh)
/// has them, texture coordinates. A `Mesh3d` that the user gives must have the vertices of the
/// [`ClothMesh`](crate::ClothMesh), in the same order. Its positions, normals and, if present, tangents are
/// overwritten in place. If several cloths use one mesh, all but the first get a copy. The meshes of coarser
/// levels take all other attributes from the finest mesh. A mesh that cannot be written is reported in a
/// [`ClothFailed`](crate::ClothFailed) event and left alone until the `Mesh3d` is replaced.
///
/// The mesh that is shown is subdivided as finely as its size on the screen asks for, see
/// [`ClothSubdivision`](crate::ClothSubdivision); the given mesh is then shown, and written, only while its edges are
/// short on the screen.
///
/// Rigid vertices, of weight 0, are written only when a cloth gets its meshes.
///
/// Meshes are made when a cloth is new, and subdivided ones when they are first shown. Later frames allocate nothing,
/// except for cloths that change their level, which are eased with the mesh of the finer level. Only meshes of cloths that move and are visible
/// to a camera or a light are written. The `Aabb` is updated whether the cloth is visible or not.
///
/// # Materials
///
/// Cloth has one layer of triangles for both of its faces. Give it a material with
/// `double_sided: true`, so that the back is lit by the normals of the back, and `cull_mode: None`,
/// so that it is drawn at all and casts a shadow; Bevy asks for both. `diffuse_transmission` lets
/// light through thin cloth.
///
/// Bevy 0.19 flips normals on the back only if the mesh has tangents and the material a normal map, or if
/// neither does: provide both or neither.
///
/// # Levels of detail
///
/// Every new `Camera3d` gets a [`LodViewer`](crate::LodViewer), whose lens and size follow the camera's
/// projection and viewport. Remove it from cameras for which levels should not be chosen.
#[derive(Debug, Default)]
pub struct ClothRenderPlugin;

impl Plugin for ClothRenderPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothFromMesh>()
            .register_type::<ClothSubdivision>()
            .register_type::<ClothDeformer>()
            .init_resource::<Subdivisions>()
            .add_observer(add_viewer)
            .add_systems(
                RunFixedMainLoop,
                (follow_cameras, make_cloths.run_if(resource_exists::<Assets<Mesh>>))
                    .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                ClothTick,
                hide_cloths
                    .in_set(ClothSystems::SelectLod)
                    .after(wake_cloths)
                    .before(select_levels),
            )
            .configure_sets(
                PostUpdate,
                (
                    ClothRenderSystems::UpdateMeshes
                        .after(TransformSystems::Propagate)
                        .before(AssetEventSystems)
                        .before(VisibilitySystems::VisibilityPropagate),
                    ClothRenderSystems::WriteNewlyVisible
                        .after(VisibilitySystems::MarkNewlyHiddenEntitiesInvisible),
                )
                    .run_if(resource_exists::<Assets<Mesh>>),
            )
            .add_systems(
                PostUpdate,
                (
                    (
                        forget_subdivisions.run_if(is_due),
                        assign_meshes,
                        bind_meshes,
                        subdivide_cloths,
                        show_level,
                        bound_cloths,
                        write_visible,
                        carry_meshes,
                    )
                        .chain()
                        .in_set(ClothRenderSystems::UpdateMeshes),
                    write_newly_visible.in_set(ClothRenderSystems::WriteNewlyVisible),
                ),
            );
    }
}
