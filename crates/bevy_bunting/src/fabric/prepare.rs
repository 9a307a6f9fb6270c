//! Prepares cloths that are new or changed: builds or looks up their fabrics, and changes their materials.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::{Isometry3d, Vec3};
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::batch::batches::ClothBatches;
use crate::cloth::activity::ClothPaused;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::imperfection::ClothSeed;
use crate::cloth::instance::{ClothInstance, Kept, Refusal, StateStorage};
use crate::cloth::material::ClothMaterial;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::place::place;
use crate::cloth::regions::ClothRegions;
use crate::cloth::resolution::ClothResolution;
use crate::cloth::state::ClothState;
use crate::fabric::attached::Attached;
use crate::fabric::levels::ClothLevels;
use crate::fabric::library::{FabricLibrary, Found};
use crate::fabric::release::{is_due, release_unused};
use crate::fabric::same_surface::has_pins_of;
use crate::fabric::scale::{ScaleBaked, bake, scale_of};
use crate::lod::budget::{ClothBudget, LodCosts};
use crate::lod::lod_set::{LodChoice, LodSet};
use crate::motion::attachment::Attachment;
use crate::motion::frame::{followed_scale, frame_of, is_finite};
use crate::motion::lost_target::handle_lost_targets;
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::schedule::{ClothSystems, ClothTick};
use crate::skeleton::skin::ClothSkin;

/// Prepares cloths that are new, changed or removed.
#[derive(Debug, Default)]
pub struct PreparePlugin;

impl Plugin for PreparePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothMesh>()
            .register_type::<ClothMaterial>()
            .register_type::<ClothSeed>()
            .register_type::<ClothResolution>()
            .register_type::<ClothRegions>()
            .init_resource::<FabricLibrary>()
            .add_observer(clear_removed)
            .add_observer(mark_released::<Attachment>)
            .add_observer(mark_released::<ClothResolution>)
            .add_observer(mark_released::<ClothRegions>)
            .add_systems(
                ClothTick,
                (
                    release_unused.run_if(is_due),
                    handle_lost_targets,
                    cut_cloths.run_if(any_may_be_stale),
                    change_materials,
                )
                    .chain()
                    .in_set(ClothSystems::Prepare),
            );
    }
}

/// Frees the lane of a cloth that is despawned, or whose [`ClothMesh`] is removed.
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

/// Rebuilds a cloth whose [`Attachment`], [`ClothResolution`] or [`ClothRegions`] is removed. An observer does this, since removal
/// messages are dropped after two frames and the next tick may come later.
fn mark_released<C: Component>(_: On<Remove, C>, mut library: ResMut<FabricLibrary>) {
    library.awaited = true;
}

type AnyChanged = Or<(
    Changed<ClothMesh>,
    Changed<ClothMaterial>,
    Changed<ClothResolution>,
    Changed<ClothRegions>,
    Changed<LodSet>,
    Changed<Attachment>,
)>;

/// Whether the fabrics of any cloth may be out of date: in most ticks none are.
fn any_may_be_stale(
    changed: Query<(), (With<ClothMesh>, AnyChanged)>,
    library: Res<FabricLibrary>,
) -> bool {
    !changed.is_empty() || library.awaited
}

/// The components that fabrics depend on, and those that depend on fabrics.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct CutCloth {
    entity: Entity,
    mesh: Ref<'static, ClothMesh>,
    material: Ref<'static, ClothMaterial>,
    lods: Ref<'static, LodSet>,
    resolution: Option<&'static ClothResolution>,
    regions: Option<Ref<'static, ClothRegions>>,
    attachment: Option<Ref<'static, Attachment>>,
    seed: Option<&'static ClothSeed>,
    has_baked: Has<ScaleBaked>,
    has_skin: Has<ClothSkin>,
    instance: &'static mut ClothInstance,
    state: &'static mut ClothState,
    history: &'static mut PoseHistory,
}

/// Builds the fabrics of cloths whose mesh, levels or attachment changed. Those that are invalid are reported: the cloth
/// keeps its last valid fabrics or, if it never had any, is not simulated, until they change again.
pub(crate) fn cut_cloths(
    mut cloths: Query<CutCloth>,
    targets: Query<(), With<Transform>>,
    transforms: TransformHelper,
    budget: Res<ClothBudget>,
    mut library: ResMut<FabricLibrary>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    library.begin_tick();
    library.may_be_late = budget.costs == LodCosts::Measured;
    for mut cloth in &mut cloths {
        let target = cloth.target();
        let awaited = cloth.instance.cutting.as_ref();
        let is_cutting =
            awaited.is_some_and(|awaited| library.is_cutting(awaited, cloth.valid_lods()));
        if is_cutting && !cloth.is_edited() {
            library.awaited = true;
            continue;
        }
        if !cloth.is_stale(target) {
            continue;
        }
        match cloth.find_levels(target, &targets, &transforms, &mut library, &mut commands) {
            Ok(Found::Awaited(awaited)) => {
                cloth.instance.cutting = Some(awaited);
                library.awaited = true;
            }
            Ok(Found::Levels(levels)) => {
                let frame = frame_of(cloth.entity, cloth.attachment.as_deref(), &transforms);
                cloth.set_levels(levels, target, frame, &mut batches, &mut commands);
            }
            Err(error) => {
                library.awaited |= matches!(error, ClothError::MissingTarget { .. });
                cloth.refuse(error, target, &mut batches, &mut commands);
            }
        }
    }
}

impl CutClothItem<'_, '_> {
    /// The attachment's target; the cloth itself if attached to its own transform.
    fn target(&self) -> Option<Entity> {
        let attachment = self.attachment.as_deref()?;
        Some(attachment.target_other_than(self.entity).unwrap_or(self.entity))
    }

    fn resolution(&self) -> ClothResolution {
        self.resolution.copied().unwrap_or_default()
    }

    /// Whether the user has changed an input of the fabrics.
    fn is_edited(&self) -> bool {
        self.history.has_new(&self.mesh)
            || self.resolution() != self.instance.resolution
            || self.regions.is_some() != self.instance.has_regions
            || self.regions.as_ref().is_some_and(|it| self.history.has_new(it))
            || self.history.has_new(&self.lods)
            || self.attachment.as_ref().is_some_and(|it| self.history.has_new(it))
    }

    /// Whether the fabrics must be looked up or built again.
    fn is_stale(&self, target: Option<Entity>) -> bool {
        let instance = &*self.instance;
        let is_known = match &instance.refusal {
            Some(refusal) => refusal.target == target,
            None => instance.target == target,
        };
        instance.cutting.is_some()
            || instance.awaits_target()
            || self.is_edited()
            || (!is_known && instance.levels.is_some())
            || (self.material.is_changed() && instance.levels.is_none())
    }

    /// Reports a mesh or an attachment that cannot be used, once, and keeps the fabrics of the former ones.
    fn refuse(
        &mut self,
        error: ClothError,
        target: Option<Entity>,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let is_edited = self.attachment.as_ref().is_some_and(|it| self.history.has_new(it));
        let known = self.instance.refusal.as_deref();
        let is_reported = known.is_some_and(|known| known.error == error);
        let refusal = Refusal {
            error,
            target,
            has_new_attachment: is_edited
                || target != self.instance.target
                || known.is_some_and(|known| known.has_new_attachment),
        };
        if known == Some(&refusal) && self.instance.cutting.is_none() {
            return;
        }
        if self.instance.levels.is_none() {
            self.instance.clear(batches);
            *self.state = ClothState::default();
        }
        self.instance.cutting = None;
        self.instance.refusal = Some(Box::new(refusal));
        if !is_reported {
            ClothFailed::report(commands, self.entity, error);
        }
    }

    /// Checks the present [`LodSet`]. One that is invalid is reported, once, and a cloth that has levels keeps its last valid
    /// one.
    ///
    /// # Errors
    ///
    /// It is invalid, and there was no valid one before.
    fn check_lods(&mut self, commands: &mut Commands) -> Result<(), ClothError> {
        let bad = self.lods.validate(self.entity).err();
        if self.instance.bad_lods == bad {
            return Ok(());
        }
        if let Some(error) = bad {
            if self.instance.levels.is_none() {
                return Err(error);
            }
            ClothFailed::report(commands, self.entity, error);
        }
        self.instance.bad_lods = bad;
        Ok(())
    }

    /// The present [`LodSet`] or, if it is invalid, the last valid one.
    fn valid_lods(&self) -> &LodSet {
        if self.instance.bad_lods.is_some() { &self.instance.lods } else { &self.lods }
    }

    /// Looks up or builds the levels of the cloth.
    fn find_levels(
        &mut self,
        target: Option<Entity>,
        targets: &Query<(), With<Transform>>,
        transforms: &TransformHelper,
        library: &mut FabricLibrary,
        commands: &mut Commands,
    ) -> Result<Found, ClothError> {
        let entity = self.entity;
        let is_missing = |target: &Entity| !self.instance.target_lost && !targets.contains(*target);
        let anchors = self.attachment.iter().flat_map(|attachment| &attachment.anchors);
        let mut needed = target.into_iter().chain(anchors.map(|anchor| anchor.target));
        if let Some(target) = needed.find(is_missing) {
            return Err(ClothError::MissingTarget { entity, target });
        }
        self.check_lods(commands)?;
        if self.instance.levels.is_none() {
            let valid = self.material.0.validate();
            valid.map_err(|source| ClothError::Material { entity, source })?;
        }
        if self.instance.cutting.is_none() || self.is_edited() {
            self.find_scale(target, transforms)?;
        }
        let attachment = self.attachment.as_deref();
        let mesh = bake(&self.mesh, self.instance.scale);
        self.instance.resolution = self.resolution();
        self.instance.has_regions = self.regions.is_some();
        let regions = self.regions.as_ref().map_or(&[][..], |regions| &regions.0);
        let attached = attachment.map(|attachment| Attached::of(attachment, &self.mesh));
        let laid = (self.resolution(), regions);
        library.levels(entity, &mesh, attached, self.valid_lods(), laid)
    }

    /// Finds the scale that is baked into the fabrics. A cloth that has grown keeps its fabrics and its size.
    fn find_scale(
        &mut self,
        target: Option<Entity>,
        transforms: &TransformHelper,
    ) -> Result<(), ClothError> {
        let (entity, attachment) = (self.entity, self.attachment.as_deref());
        let followed = followed_scale(entity, attachment, transforms).unwrap_or(Vec3::ONE);
        let is_attached = target.is_some_and(|target| target != entity);
        let instance = &*self.instance;
        let growth = &instance.growth;
        // A mesh that is made anew from an asset has the whole scale.
        let is_whole = self.has_baked && self.history.has_new(&self.mesh);
        let is_other = instance.target != target;
        let keeps = growth.is_known()
            && !is_whole
            && (is_other || is_attached || growth.size_with(followed).is_some());
        let size = if keeps { growth.present(followed) } else { 1.0 };
        let has_scale = self.has_baked || self.has_skin;
        let scale = scale_of(entity, attachment, has_scale, size, transforms)?;
        let instance = &mut *self.instance;
        instance.scale = scale;
        if !keeps {
            instance.growth.restart(followed);
        } else if is_other {
            instance.growth.keep_with(followed);
        }
        Ok(())
    }

    /// Simulates the cloth with new levels from now on.
    fn set_levels(
        &mut self,
        levels: Arc<ClothLevels>,
        target: Option<Entity>,
        frame: Option<Isometry3d>,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let change = self.set_target(target, frame, commands);
        if *self.valid_lods() != self.instance.lods {
            self.instance.lods = self.valid_lods().clone();
        }
        let instance = &mut *self.instance;
        instance.cutting = None;
        instance.refusal = None;
        if instance.levels.as_ref().is_some_and(|old| Arc::ptr_eq(old, &levels)) {
            return;
        }
        if instance.levels.is_none() {
            instance.material = self.material.0;
            let of_frame = || frame.as_ref().map(ClothSeed::of_frame).unwrap_or_default();
            instance.seed = self.seed.copied().unwrap_or_else(of_frame);
            if matches!(self.lods.choice, LodChoice::Automatic { .. }) {
                // Most cloths of a large scene stay there, and finer states take longer to make.
                instance.level = levels.count() - 1;
            }
        }
        let entity = self.entity;
        if let Some(fewer) = levels.tell_fewer(entity, self.mesh.as_grid()) {
            commands.queue(move |world: &mut World| {
                log::warn!("{}{fewer}", place(world, entity));
            });
        }
        let former = instance.fabric().cloned();
        let was_free = former.as_ref().is_some_and(|fabric| !fabric.has_pins());
        let kept = instance.replace_levels(levels, batches);
        let under_way = instance.taking_up.take();
        instance.taking_up = match (instance.fabric().cloned(), &mut instance.storage) {
            // Pins that are only let go do not move those that stay.
            (Some(fabric), StateStorage::Snapshot(state))
                if kept == Kept::State
                    && change == Isometry3d::IDENTITY
                    && former.is_some_and(|former| has_pins_of(&fabric, &former)) =>
            {
                **state = core::mem::take(&mut **state).without_history();
                under_way.map(|way| way.of_pins(&fabric))
            }
            // The same with other particles.
            _ if kept == (Kept::Surface { had_pins: true })
                && change == Isometry3d::IDENTITY
                && under_way.is_none() =>
            {
                None
            }
            (Some(fabric), StateStorage::Snapshot(state)) if kept != Kept::Nothing => {
                TakingUp::begin(state, &fabric, change, was_free)
            }
            _ => None,
        };
        if let Some((levels, snapshot)) = instance.levels.as_ref().zip(instance.snapshot()) {
            self.state.restart(instance.level, levels, &snapshot.positions);
        }
    }
}

impl CutClothItem<'_, '_> {
    /// Stores the target. Returns the transformation from the frame on the old target to the frame on the new
    /// one.
    fn set_target(
        &mut self,
        target: Option<Entity>,
        frame: Option<Isometry3d>,
        commands: &mut Commands,
    ) -> Isometry3d {
        let instance = &mut *self.instance;
        if instance.target == target {
            return Isometry3d::IDENTITY;
        }
        let before = self.history.is_observed().then(|| self.history.end());
        *self.history = PoseHistory::default();
        instance.target = target;
        instance.target_lost = false;
        if core::mem::take(&mut instance.frozen) {
            commands.entity(self.entity).remove::<ClothPaused>();
        }
        let change = before.zip(frame).map(|(before, now)| now.inverse() * before);
        let mut change = change.filter(is_finite).unwrap_or_default();
        change.translation /= instance.growth.end();
        change
    }
}

/// Changes materials from this tick on. An invalid material is reported, and the last valid one is kept.
pub(crate) fn change_materials(
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
        if let Some(lane) = instance.lane() {
            batches.lane(lane).set_material(instance.acting_material());
        }
    }
}
