//! Makes cloths of the meshes that entities already have.

use std::collections::HashSet;

use bevy_asset::{AssetEvent, AssetId, AssetServer, Assets, Handle, LoadState};
use bevy_camera::visibility::DynamicSkinnedMeshBounds;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::Vec3;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_mesh::{Mesh, Mesh3d};
use bevy_transform::helper::TransformHelper;

use crate::cloth::activity::ClothActivity;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::state::ClothState;
use crate::fabric::scale::ScaleBaked;
use crate::motion::attachment::Attachment;
use crate::render::cloth_from_mesh::ClothFromMesh;
use crate::render::convert_mesh::Converted;
use crate::render::deformer::Carried;
use crate::render::from_skin::{BindPoses, LoadedSkin, unbind};
use crate::render::level_meshes::LevelMeshes;
use crate::render::mesh_content::{changed_meshes, content_of};
use crate::render::painted_regions::painted_regions;
use crate::render::painted_vertices::painted_attachment;
use crate::render::source_mesh::SourceMesh;
use crate::skeleton::limits::SkinLimits;

/// Marks a cloth whose mesh is not loaded yet.
#[derive(Component, Clone, Copy, Debug)]
pub struct AwaitsMesh;

/// An entity that asks for a cloth.
#[derive(QueryData)]
#[query_data(mutable)]
pub struct Asked {
    entity: Entity,
    wanted: Ref<'static, ClothFromMesh>,
    shown: Ref<'static, Mesh3d>,
    known: Option<&'static SourceMesh>,
    levels: Option<&'static LevelMeshes>,
    carried: Option<&'static Carried>,
    skinned: Option<&'static SkinnedMesh>,
    limits: Option<&'static SkinLimits>,
    attachment: Option<&'static Attachment>,
    state: &'static mut ClothState,
    awaits: Has<AwaitsMesh>,
    is_cloth: Has<ClothMesh>,
}

impl AskedItem<'_, '_> {
    /// Whether the plugin has made the mesh that is shown now, so that the user has given no other one.
    fn shows_own(&self) -> bool {
        let shown = self.shown.id();
        self.known.is_some_and(|known| known.shows(shown))
            || self.levels.is_some_and(|levels| levels.contains(shown))
            || self.carried.is_some_and(|carried| carried.shows(shown))
    }

    /// The mesh that a cloth is to be made of, if there is one to be made.
    fn source(
        &self,
        changed: &HashSet<AssetId<Mesh>>,
        meshes: &Assets<Mesh>,
    ) -> Option<Handle<Mesh>> {
        let Some(known) = self.known.filter(|_| self.shows_own()) else {
            return Some(self.shown.0.clone());
        };
        let source = known.source.id();
        let has_changed = || {
            let content = changed.contains(&source).then(|| meshes.get(source).map(content_of));
            content.is_some_and(|content| content != known.content)
        };
        let is_stale = self.wanted.is_changed() || self.awaits || has_changed();
        is_stale.then(|| known.source.clone())
    }

    /// The skin that leads the cloth, if the mesh is skinned.
    fn skin(&self) -> Option<SkinnedMesh> {
        let known = self.known.filter(|_| self.shows_own());
        self.skinned.or_else(|| known.and_then(|known| known.skin.as_ref())).cloned()
    }

    /// The mesh that shows the cloth that was made last; none if none was made.
    fn last_good(&self) -> Option<Handle<Mesh>> {
        let of_levels = self.levels.and_then(|levels| levels.meshes.first());
        let of_carried = self.carried.map(|carried| carried.shown());
        let known = self.known.filter(|_| self.is_cloth)?;
        Some(of_levels.or(of_carried).unwrap_or(&known.shown).clone())
    }

    /// Notes the mesh that no cloth could be made of, or not yet. A cloth that was made before is shown further on.
    fn keep_last_good(&mut self, of: SourceMesh, commands: &mut Commands) {
        let mut cloth = commands.entity(self.entity);
        match self.last_good() {
            Some(shown) => {
                let own = self.known.map_or(&shown, |known| &known.shown).clone();
                cloth.insert(SourceMesh { shown: own, ..of });
                if self.shown.0 != shown {
                    cloth.insert(Mesh3d(shown));
                }
            }
            None => {
                cloth.insert(of);
            }
        }
    }
}

/// Makes cloths of meshes that are new or changed, or have been loaded since the last frame.
pub fn make_cloths(
    mut asked: Query<Asked>,
    written: Query<&LevelMeshes>,
    mut events: MessageReader<AssetEvent<Mesh>>,
    (server, poses): (Option<Res<AssetServer>>, BindPoses),
    transforms: TransformHelper,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    let changed = changed_meshes(&mut events, &written);
    for mut cloth in &mut asked {
        let Some(source) = cloth.source(&changed, &meshes) else { continue };
        let (entity, skin) = (cloth.entity, cloth.skin());
        let loaded = skin.as_ref().map(|skin| LoadedSkin::of(skin, &poses));
        let mesh = meshes.get(&source).filter(|_| loaded.as_ref().is_none_or(Option::is_some));
        let content = mesh.map(content_of);
        let made_of = SourceMesh {
            shown: source.clone(),
            source: source.clone(),
            content,
            skin: skin.clone(),
        };
        let Some(mesh) = mesh else {
            let state = server.as_ref().map(|server| server.load_state(source.id()));
            let has_failed = matches!(state, Some(LoadState::Failed(_)));
            if has_failed {
                commands.entity(entity).remove::<AwaitsMesh>();
                ClothFailed::report(&mut commands, entity, ClothError::MeshNotLoaded { entity });
            } else if !cloth.awaits {
                commands.entity(entity).insert(AwaitsMesh);
            }
            if !cloth.is_cloth {
                let waits = ClothActivity::AwaitsAsset;
                cloth.state.activity = if has_failed { ClothActivity::Failed } else { waits };
            }
            cloth.keep_last_good(made_of, &mut commands);
            continue;
        };
        let loaded = loaded.flatten();
        let of_entity = || transforms.compute_global_transform(entity).map(|global| global.scale());
        let scale = match &loaded {
            Some(skin) => skin.scale(&transforms),
            None => of_entity().unwrap_or(Vec3::ONE),
        };
        let scale = if is_scale(scale) { scale } else { Vec3::ONE };
        let wanted = &cloth.wanted;
        let converted = wanted.convert(entity, mesh, scale).and_then(|converted| {
            let mesh = &converted.shown;
            let limits = wanted.painted_limits(cloth.limits, entity, mesh)?;
            let attachment = painted_attachment(&wanted.held, cloth.attachment, entity, mesh)?;
            let regions = painted_regions(&wanted.regions, entity, mesh)?;
            Ok((converted, limits, attachment, regions))
        });
        commands.entity(entity).remove::<AwaitsMesh>();
        match converted {
            Ok((converted, limits, attachment, regions)) => {
                let mut made = commands.entity(entity);
                if let Some(limits) = limits {
                    made.insert(limits);
                }
                if let Some(attachment) = attachment {
                    made.insert(attachment);
                }
                if let Some(regions) = regions {
                    made.insert(regions);
                }
                show(converted, (loaded, scale), made_of, &mut meshes, &mut made);
            }
            Err(error) => {
                if !cloth.is_cloth {
                    cloth.state.activity = ClothActivity::Failed;
                }
                cloth.keep_last_good(made_of, &mut commands);
                ClothFailed::report(&mut commands, entity, error);
            }
        }
    }
}

/// Makes an entity a cloth, and shows its mesh.
fn show(
    Converted { shape, mut shown }: Converted,
    (loaded, scale): (Option<LoadedSkin>, Vec3),
    made_of: SourceMesh,
    meshes: &mut Assets<Mesh>,
    made: &mut EntityCommands,
) {
    if let Some(skin) = loaded {
        made.insert(skin.convert(&shown, scale));
        made.remove::<(SkinnedMesh, DynamicSkinnedMeshBounds)>();
        unbind(&mut shown);
    }
    let copy = meshes.add(shown);
    let made_of = SourceMesh { shown: copy.clone(), ..made_of };
    made.insert((shape, made_of, ScaleBaked, Mesh3d(copy)));
}

/// Whether a scale can be baked.
fn is_scale(scale: Vec3) -> bool {
    scale.is_finite() && scale.cmpne(Vec3::ZERO).all()
}
