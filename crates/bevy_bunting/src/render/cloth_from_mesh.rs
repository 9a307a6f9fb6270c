//! Makes cloths of the meshes that entities already have.

use bevy_asset::{AssetId, AssetServer, Assets, Handle, LoadState, RenderAssetUsages};
use bevy_camera::visibility::DynamicSkinnedMeshBounds;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_mesh::{Indices, Mesh, Mesh3d};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::mesh::ClothMesh;
use crate::fabric::scale::ScaleBaked;
use crate::motion::attachment::Attachment;
use crate::render::deformer::{Carried, ClothDeformer};
use crate::render::from_skin::{BindPoses, LoadedSkin, unbind};
use crate::render::level_mesh::with_vertices;
use crate::render::level_meshes::LevelMeshes;
use crate::render::painted_vertices::{PaintedVertices, painted_attachment};
use crate::render::painted_weights::{PaintedDistance, PaintedWeights};
use crate::skeleton::by_vertex::ByVertex;
use crate::skeleton::limits::SkinLimits;

/// Makes the entity's own `Mesh3d` a cloth, as soon as it is loaded: inserts a [`ClothMesh`] and shows a copy of the
/// mesh, which keeps its texture coordinates, tangents, vertex colours and all other attributes. The
/// material stays. Other entities with the same mesh asset stay as they are.
///
/// A skinned mesh becomes a cloth that its skeleton leads: Bevy's `SkinnedMesh` is replaced by a
/// [`ClothSkin`](crate::ClothSkin), and the copy has no joints.
///
/// Scales of the entity and its parents, or of the skeleton, are baked into the copy, since a cloth's frame has no scale; a
/// scale of zero is ignored. A change of this component or of the `Mesh3d` makes the cloth anew.
///
/// # Errors
///
/// A [`ClothFailed`] event tells what cannot be used: a mesh that failed to load, one that is kept in the
/// render world only, values that are not painted, painted vertices that no anchor holds, or a defect of the mesh. The
/// entity is shown as before.
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
pub struct ClothFromMesh {
    /// Whether the mesh is [repaired](ClothMesh::repaired) before. Vertices are then numbered anew, which matters
    /// for [`AttachedVertices::List`](crate::AttachedVertices::List).
    pub repair: bool,
    /// Whether texture coordinates of the mesh are left out of the cloth; they are shown all the same. The warp runs
    /// along u: leave out coordinates that have nothing to do with the weave, as those of an atlas.
    pub ignore_uv: bool,
    /// Weights of the vertices, painted by the artist; without them all vertices are simulated. What
    /// is pinned stays on the entity, or on the target of its [`Attachment`](crate::Attachment) if it has one.
    pub weights: Option<PaintedWeights>,
    /// Greatest number of simulated vertices. A mesh with more is simulated as one with fewer triangles, which carries the
    /// detailed one like a [`ClothDeformer`](crate::ClothDeformer); pinned and held vertices stay, as
    /// [`FabricBuilder::decimated`](bunting_solver::FabricBuilder::decimated) says. The [`ClothMesh`] has the vertices of the
    /// simple mesh, by which [`AttachedVertices::List`](crate::AttachedVertices::List) names them.
    pub max_vertices: Option<u32>,
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
}

impl ClothFromMesh {
    /// Reads weights from the red channel of the vertex colours: red is pinned.
    #[must_use]
    pub fn painted() -> Self {
        Self { weights: Some(PaintedWeights::default()), ..Self::default() }
    }
}

/// The mesh that a cloth is made of.
#[derive(Component, Clone, Debug)]
pub struct SourceMesh {
    source: Handle<Mesh>,
    /// The mesh that was shown when the cloth was made: the copy or, if no cloth was made, the source.
    shown: AssetId<Mesh>,
    /// The skin of the source.
    skin: Option<SkinnedMesh>,
}

impl SourceMesh {
    /// The mesh that the cloth is made of.
    pub(crate) fn source(&self) -> &Handle<Mesh> {
        &self.source
    }
}

/// Marks a cloth whose mesh is not loaded yet.
#[derive(Component, Clone, Copy, Debug)]
pub struct AwaitsMesh;

type Asked = (
    Entity,
    Ref<'static, ClothFromMesh>,
    &'static Mesh3d,
    Option<&'static SourceMesh>,
    Option<&'static LevelMeshes>,
    Option<&'static Carried>,
    Option<&'static SkinnedMesh>,
    Option<&'static SkinLimits>,
    Option<&'static Attachment>,
    Has<AwaitsMesh>,
);
type MayBeStale = Or<(Changed<ClothFromMesh>, Changed<Mesh3d>, With<AwaitsMesh>)>;

/// Makes cloths of meshes that are new, changed or have been loaded since the last frame.
pub fn make_cloths(
    asked: Query<Asked, MayBeStale>,
    server: Option<Res<AssetServer>>,
    poses: BindPoses,
    transforms: TransformHelper,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    for (entity, wanted, shown, known, levels, carried, skinned, limits, attachment, awaits) in
        &asked
    {
        let is_own = |known: &&SourceMesh| {
            known.shown == shown.id()
                || levels.is_some_and(|levels| levels.contains(shown.id()))
                || carried.is_some_and(|carried| carried.shows(shown.id()))
        };
        let known = known.filter(is_own);
        if known.is_some() && !wanted.is_changed() && !awaits {
            continue;
        }
        let source = known.map_or(&shown.0, |known| &known.source).clone();
        let skin = skinned.or_else(|| known.and_then(|known| known.skin.as_ref())).cloned();
        let mut cloth = commands.entity(entity);
        let loaded = skin.as_ref().map(|skin| LoadedSkin::of(skin, &poses));
        let mesh = meshes.get(&source).filter(|_| loaded.as_ref().is_none_or(Option::is_some));
        let Some(mesh) = mesh else {
            cloth.insert(SourceMesh { source: source.clone(), shown: shown.id(), skin });
            let state = server.as_ref().map(|server| server.load_state(source.id()));
            if matches!(state, Some(LoadState::Failed(_))) {
                cloth.remove::<AwaitsMesh>();
                ClothFailed::report(&mut commands, entity, ClothError::MeshNotLoaded { entity });
            } else if !awaits {
                cloth.insert(AwaitsMesh);
            }
            continue;
        };
        let loaded = loaded.flatten();
        let of_entity = || transforms.compute_global_transform(entity).map(|global| global.scale());
        let scale = match &loaded {
            Some(skin) => skin.scale(&transforms),
            None => of_entity().unwrap_or(Vec3::ONE),
        };
        let scale = if is_scale(scale) { scale } else { Vec3::ONE };
        let converted = wanted.convert(entity, mesh, scale).and_then(|converted| {
            let limits = wanted.painted_limits(limits, entity, converted.of_shape())?;
            let attachment =
                painted_attachment(&wanted.held, attachment, entity, converted.of_shape())?;
            Ok((converted, limits, attachment))
        });
        match converted {
            Ok((Converted { shape, mut shown, simple }, limits, attachment)) => {
                if let Some(skin) = loaded {
                    cloth.insert(skin.convert(simple.as_ref().unwrap_or(&shown), scale));
                    cloth.remove::<(SkinnedMesh, DynamicSkinnedMeshBounds)>();
                    unbind(&mut shown);
                }
                if let Some(limits) = limits {
                    cloth.insert(limits);
                }
                if let Some(attachment) = attachment {
                    cloth.insert(attachment);
                }
                if simple.is_some() {
                    cloth.insert(ClothDeformer { cloth: entity }).remove::<LevelMeshes>();
                } else if carried.is_some_and(|carried| carried.is_of(entity)) {
                    cloth.remove::<(ClothDeformer, Carried)>();
                }
                let copy = meshes.add(shown);
                let made_of = SourceMesh { source, shown: copy.id(), skin };
                cloth.insert((shape, made_of, ScaleBaked, Mesh3d(copy)));
                cloth.remove::<AwaitsMesh>();
            }
            Err(error) => {
                let made_of = SourceMesh { source, shown: shown.id(), skin };
                cloth.insert(made_of).remove::<AwaitsMesh>();
                ClothFailed::report(&mut commands, entity, error);
            }
        }
    }
}

/// Whether a scale can be baked.
fn is_scale(scale: Vec3) -> bool {
    scale.is_finite() && scale.cmpne(Vec3::ZERO).all()
}

/// The cloth that a mesh becomes.
struct Converted {
    shape: ClothMesh,
    /// The mesh that shows it.
    shown: Mesh,
    /// The mesh with the vertices of the shape, if these are fewer than those that are shown.
    simple: Option<Mesh>,
}

impl Converted {
    /// The mesh with the vertices of the shape.
    fn of_shape(&self) -> &Mesh {
        self.simple.as_ref().unwrap_or(&self.shown)
    }
}

impl ClothFromMesh {
    /// The limits of a skinned mesh with those that are painted; none if none are.
    fn painted_limits(
        &self,
        limits: Option<&SkinLimits>,
        entity: Entity,
        mesh: &Mesh,
    ) -> Result<Option<SkinLimits>, ClothError> {
        let mut limits = limits.cloned().unwrap_or_default();
        let mut are_painted = false;
        for (painted, limit) in [
            (&self.max_distance, &mut limits.max_distance),
            (&self.backstop_radius, &mut limits.backstop_radius),
            (&self.backstop_distance, &mut limits.backstop_distance),
        ] {
            if let Some(painted) = painted {
                *limit = ByVertex::Each(painted.read(entity, mesh)?);
                are_painted = true;
            }
        }
        Ok(are_painted.then_some(limits))
    }

    /// The cloth of a mesh with a scale.
    fn convert(&self, entity: Entity, mesh: &Mesh, scale: Vec3) -> Result<Converted, ClothError> {
        let is_kept = mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD);
        if !is_kept || mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION).is_err() {
            return Err(ClothError::MeshUnreadable { entity });
        }
        let mut shown = mesh.clone();
        if scale != Vec3::ONE {
            shown.scale_by(scale);
            if scale.element_product() < 0.0 {
                // A mesh that is no list of triangles gives an empty cloth, which is reported later.
                let _ = shown.invert_winding();
            }
        }
        let mut shape = ClothMesh::from(&shown);
        if let (ClothMesh::Triangles { uv, .. }, true) = (&mut shape, self.ignore_uv) {
            uv.clear();
        }
        if let Some(painted) = &self.weights {
            shape = shape.with_weights(painted.read(entity, &shown)?);
        }
        if self.repair {
            let repaired = shape.repaired();
            let (repaired, report) =
                repaired.map_err(|source| ClothError::Mesh { entity, source })?;
            shape = repaired;
            shown = with_vertices(shown, report.vertices);
            if let ClothMesh::Triangles { indices, .. } = &shape {
                shown.insert_indices(Indices::U32(indices.clone()));
            }
        }
        let mut held = Vec::new();
        for painted in &self.held {
            held.extend(painted.read(entity, &shown)?);
        }
        let simplified = self.max_vertices.and_then(|most| shape.simplified(most as usize, &held));
        let simple = simplified.map(|(simplified, vertices)| {
            shape = simplified;
            with_vertices(shown.clone(), vertices)
        });
        Ok(Converted { shape, shown, simple })
    }
}
