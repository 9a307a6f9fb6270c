//! What asks for a cloth of a mesh.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::state::ClothState;
use crate::render::painted_regions::PaintedRegion;
use crate::render::painted_vertices::PaintedVertices;
use crate::render::painted_weights::{PaintedDistance, PaintedWeights};

/// Makes the entity's own `Mesh3d` a cloth, as soon as it is loaded: inserts a [`ClothMesh`](crate::ClothMesh) and shows a copy of the
/// mesh, which keeps its texture coordinates, tangents, vertex colours and all other attributes. The
/// material stays. Other entities with the same mesh asset stay as they are. How finely the cloth is simulated does not depend on
/// the mesh's triangles, but on its [`ClothResolution`](crate::ClothResolution).
///
/// A skinned mesh becomes a cloth that its skeleton leads: Bevy's `SkinnedMesh` is replaced by a
/// [`ClothSkin`](crate::ClothSkin), and the copy has no joints.
///
/// Scales of the entity and its parents, or of the skeleton, are baked into the copy, as those of any cloth into its fabric; a
/// scale of zero is ignored. A change of this component, of the `Mesh3d`, or of the mesh asset itself makes the cloth anew.
///
/// # Errors
///
/// A [`ClothFailed`](crate::ClothFailed) event tells what cannot be used: a mesh that failed to load, one that is kept in the
/// render world only, values that are not painted, painted vertices that no anchor holds, or a defect of the mesh, whose
/// vertices it names by their numbers in the given mesh. The entity is shown as before, and a cloth that was made before is
/// simulated further on.
///
/// ```no_run
/// use bevy_asset::AssetServer;
/// use bevy_bunting::prelude::*;
/// use bevy_bunting::ClothFromMesh;
/// use bevy_ecs::prelude::*;
/// use bevy_mesh::Mesh3d;
///
/// fn spawn(mut commands: Commands, assets: Res<AssetServer>) {
///     commands.spawn((
///         Mesh3d(assets.load("cape.glb#Mesh0/Primitive0")),
///         ClothFromMesh { repair: true, ..ClothFromMesh::painted() },
///         ClothMaterial::FLAG_POLYESTER,
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(ClothState)]
pub struct ClothFromMesh {
    /// Whether the mesh is [repaired](crate::ClothMesh::repaired) before. Vertices are then numbered anew, which matters
    /// for [`AttachedVertices::List`](crate::AttachedVertices::List).
    pub repair: bool,
    /// Whether texture coordinates of the mesh are left out of the cloth; they are shown all the same. The warp runs
    /// along u: leave out coordinates that have nothing to do with the weave, as those of an atlas.
    pub ignore_uv: bool,
    /// Weights of the vertices, painted by the artist; without them all vertices are simulated. What
    /// is pinned stays on the entity, or on the target of its [`Attachment`](crate::Attachment) if it has one.
    pub weights: Option<PaintedWeights>,
    /// Greatest distances of the particles of a skinned mesh from their animated places, painted by the artist; written into
    /// the entity's [`SkinLimits`](crate::SkinLimits).
    pub max_distance: Option<PaintedDistance>,
    /// Radii of the backstops of a skinned mesh, painted by the artist; written into the entity's `SkinLimits`.
    pub backstop_radius: Option<PaintedDistance>,
    /// Distances of the backstops of a skinned mesh, painted by the artist; written into the entity's `SkinLimits`.
    pub backstop_distance: Option<PaintedDistance>,
    /// Vertices that the entity's [`Attachment`](crate::Attachment) holds, then those that each of its anchors holds,
    /// painted by the artist; written into the attachment, which must be there when the mesh is loaded.
    pub held: Vec<PaintedVertices>,
    /// Regions in which the material differs, painted by the artist; if there are any, they become the entity's
    /// [`ClothRegions`](crate::ClothRegions) in place of others.
    pub regions: Vec<PaintedRegion>,
}

impl ClothFromMesh {
    /// Reads weights from the red channel of the vertex colours: red is pinned.
    #[must_use]
    pub fn painted() -> Self {
        Self { weights: Some(PaintedWeights::default()), ..Self::default() }
    }
}
