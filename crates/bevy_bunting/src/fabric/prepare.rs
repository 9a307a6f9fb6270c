//! New, changed and removed cloths.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Isometry3d;
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::{ClothError, ClothFailed};
use crate::cloth::imperfection::ClothSeed;
use crate::cloth::instance::{ClothInstance, Place};
use crate::cloth::mesh::{ClothMaterial, ClothMesh, ClothPaused};
use crate::cloth::state::ClothState;
use crate::fabric::levels::FabricLibrary;
use crate::lod::LodSet;
use crate::motion::attachment::{Attachment, TargetLost};
use crate::motion::frame::{frame_of, is_finite};
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::schedule::{ClothSystems, ClothTick};

/// The target of a cloth's attachment was despawned.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothTargetLost {
    /// The cloth.
    pub entity: Entity,
    /// The target that is gone.
    pub target: Entity,
    /// What happens to the cloth.
    pub outcome: TargetLost,
}

/// Cuts cloths when they are new or changed.
#[derive(Debug, Default)]
pub struct PreparePlugin;

impl Plugin for PreparePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothMesh>()
            .register_type::<ClothMaterial>()
            .register_type::<ClothSeed>()
            .init_resource::<FabricLibrary>()
            .add_observer(clear_removed)
            .add_observer(note_release)
            .add_systems(
                ClothTick,
                (lose_targets, cut_cloths.run_if(may_cut), change_materials)
                    .chain()
                    .in_set(ClothSystems::Prepare),
            );
    }
}

/// Frees the lane of a cloth that is despawned, or is one no more.
fn clear_removed(
    removed: On<Remove, ClothMesh>,
    mut cloths: Query<(&mut ClothInstance, &mut ClothState)>,
    mut batches: ResMut<ClothBatches>,
) {
    if let Ok((mut instance, mut state)) = cloths.get_mut(removed.entity) {
        instance.clear(&mut batches);
        *state = ClothState::default();
    }
}

/// A cloth that has let go is cut anew. Messages of removals would be gone after two frames, and a tick may
/// take longer to come.
fn note_release(_: On<Remove, Attachment>, mut library: ResMut<FabricLibrary>) {
    library.awaited = true;
}

fn lose_targets(
    mut cloths: Query<(Entity, &Attachment, &mut ClothInstance, Has<ClothPaused>)>,
    targets: Query<(), With<Transform>>,
    mut commands: Commands,
) {
    for (entity, attachment, mut instance, paused) in &mut cloths {
        let Some(target) = attachment.target_other_than(entity) else { continue };
        if instance.target_lost || instance.target != Some(target) || targets.contains(target) {
            continue;
        }
        instance.target_lost = true;
        match attachment.on_lost {
            TargetLost::Freeze => {
                instance.frozen = !paused;
                commands.entity(entity).insert(ClothPaused)
            }
            TargetLost::Release => commands.entity(entity).remove::<Attachment>(),
        };
        commands.trigger(ClothTargetLost { entity, target, outcome: attachment.on_lost });
    }
}

type MayCut =
    Or<(Changed<ClothMesh>, Changed<ClothMaterial>, Changed<LodSet>, Changed<Attachment>)>;

/// Whether there may be a cloth to cut: in most ticks there is none.
fn may_cut(changed: Query<(), (With<ClothMesh>, MayCut)>, library: Res<FabricLibrary>) -> bool {
    !changed.is_empty() || library.awaited
}

type Cloths<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        Ref<'static, ClothMesh>,
        Ref<'static, ClothMaterial>,
        Ref<'static, LodSet>,
        Option<Ref<'static, Attachment>>,
        Option<&'static ClothSeed>,
        &'static mut ClothInstance,
        &'static mut ClothState,
        &'static mut PoseHistory,
    ),
>;

/// Cuts the fabrics of cloths whose mesh, levels or attachment are new. A bad cloth is reported and
/// not simulated until it changes again.
fn cut_cloths(
    mut cloths: Cloths,
    targets: Query<(), With<Transform>>,
    transforms: TransformHelper,
    mut library: ResMut<FabricLibrary>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    library.begin_tick();
    for (entity, mesh, material, lods, attachment, seed, mut instance, mut state, mut history) in
        &mut cloths
    {
        let target = attachment
            .as_deref()
            .map(|attachment| attachment.target_other_than(entity).unwrap_or(entity));
        let changed = instance.cutting
            || instance.awaits_target.is_some()
            || mesh.is_changed()
            || lods.is_changed()
            || attachment.as_ref().is_some_and(|attachment| attachment.is_changed())
            || (instance.target != target && instance.levels.is_some())
            || (material.is_changed() && instance.levels.is_none());
        if !changed {
            continue;
        }
        let missing = target.filter(|&target| !instance.target_lost && !targets.contains(target));
        let levels = match (missing, material.0.validate()) {
            (Some(target), _) => Err(ClothError::MissingTarget { entity, target }),
            (_, Err(source)) if instance.levels.is_none() => {
                Err(ClothError::Material { entity, source })
            }
            _ => library.levels(entity, &mesh, attachment.as_deref(), &lods),
        };
        match levels {
            Ok(None) => {
                instance.cutting = true;
                library.awaited = true;
            }
            Ok(Some(levels)) => {
                instance.cutting = false;
                instance.awaits_target = None;
                let pose = frame_of(entity, attachment.as_deref(), &transforms);
                let mut change = Isometry3d::IDENTITY;
                if instance.target != target {
                    let before = history.is_known().then(|| history.end());
                    if let (Some(before), Some(now)) = (before, pose) {
                        change = now.inverse() * before;
                    }
                    *history = PoseHistory::default();
                    instance.target = target;
                    instance.target_lost = false;
                    if core::mem::take(&mut instance.frozen) {
                        commands.entity(entity).remove::<ClothPaused>();
                    }
                }
                if instance.levels.as_ref().is_some_and(|old| Arc::ptr_eq(old, &levels)) {
                    continue;
                }
                if instance.levels.is_none() {
                    instance.material = material.0;
                    instance.seed = seed.copied().unwrap_or_else(|| {
                        pose.as_ref().map_or(ClothSeed::default(), ClothSeed::of_pose)
                    });
                }
                if let Some(lack) = levels.lack(entity, &mesh) {
                    ClothFailed::report(&mut commands, entity, lack);
                }
                let fabric = Arc::clone(levels.fabric(instance.level));
                let kept = instance.recut(levels, &mut batches);
                if let (true, Place::Waiting(snapshot)) = (kept, &mut instance.place) {
                    let change = if is_finite(&change) { change } else { Isometry3d::IDENTITY };
                    match TakingUp::begin(snapshot, &fabric, change) {
                        Some(way) => commands.entity(entity).insert(way),
                        None => commands.entity(entity).remove::<TakingUp>(),
                    };
                }
                if let Some((levels, snapshot)) = instance.levels.as_ref().zip(instance.waiting()) {
                    state.begin_anew(instance.level, levels, &snapshot.positions);
                }
            }
            Err(ClothError::MissingTarget { target, .. })
                if instance.awaits_target == Some(target) =>
            {
                library.awaited = true;
            }
            Err(error) => {
                instance.clear(&mut batches);
                if let ClothError::MissingTarget { target, .. } = error {
                    instance.awaits_target = Some(target);
                    library.awaited = true;
                }
                *state = ClothState::default();
                ClothFailed::report(&mut commands, entity, error);
            }
        }
    }
}

/// Changes materials from this tick on. A bad one is reported, and the last good one kept.
fn change_materials(
    mut cloths: Query<(Entity, &ClothMaterial, &mut ClothInstance), Changed<ClothMaterial>>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    for (entity, material, mut instance) in &mut cloths {
        if instance.levels.is_none() || instance.material == material.0 {
            continue;
        }
        if let Err(source) = material.0.validate() {
            ClothFailed::report(&mut commands, entity, ClothError::Material { entity, source });
            continue;
        }
        instance.material = material.0;
        instance.wake();
        if let Some(slot) = instance.slot() {
            batches.lane(slot).set_material(material.0);
        }
    }
}
