//! The mesh that a cloth is made of.

use bevy_asset::{AssetId, Handle};
use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMesh;

/// The mesh that a cloth is made of.
#[derive(Component, Clone, Debug)]
pub struct SourceMesh {
    pub(super) source: Handle<Mesh>,
    /// What the source contained when it was last read, see [`content_of`](crate::render::mesh_content::content_of); none if it is not loaded.
    pub(super) content: Option<u64>,
    /// The mesh that was shown when the cloth was made: the copy or, if no cloth was made, the source.
    pub(super) shown: Handle<Mesh>,
    /// The skin of the source.
    pub(super) skin: Option<SkinnedMesh>,
}

impl SourceMesh {
    /// The mesh that the cloth is made of.
    pub(crate) fn source(&self) -> &Handle<Mesh> {
        &self.source
    }

    /// Whether this is the mesh that was shown when the cloth was made.
    pub(super) fn shows(&self, mesh: AssetId<Mesh>) -> bool {
        self.shown.id() == mesh
    }
}
