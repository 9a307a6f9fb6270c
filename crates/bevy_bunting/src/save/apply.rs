//! Gives a cloth the state of a snapshot that fits it.

use std::sync::Arc;

use bevy_ecs::prelude::*;

use crate::anchors::reactions::AnchorReactions;
use crate::batch::batches::ClothBatches;
use crate::cloth::activity::ClothPaused;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::cloth::material::ClothMaterial;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::regions::ClothRegions;
use crate::cloth::resolution::ClothResolution;
use crate::cloth::restored::Restored;
use crate::cloth::state::ClothState;
use crate::lod::effort::ClothEffort;
use crate::lod::lod_set::LodSet;
use crate::lod::record::LodRecord;
use crate::lod::rest_timer::RestTimer;
use crate::lod::select::LevelSelector;
use crate::motion::anchor_pins::AnchorPins;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::save::check::Fitting;
use crate::save::cloth::{SavedCloth, SavedSkin};
use crate::save::take::News;
use crate::seams::sewn::SewnCloth;
use crate::settings::ClothSettings;
use crate::skeleton::check::led_by;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::limits::SkinLimits;
use crate::skeleton::particles::SkinnedParticles;
use crate::skeleton::skin::ClothSkin;

/// Restores all of a cloth but its lane: its state is then that of a cloth that waits for one.
pub(super) fn apply(world: &mut World, fitting: &Fitting, saved: &SavedCloth) {
    let entity = fitting.entity;
    leave_lane(world, entity);
    let now = *world.resource::<ObservationTimes>();
    restore_instance(world, fitting, saved);
    restore_motion(world, entity, saved, &now);
    restore_skin(world, fitting, saved, &now);
    restore_choices(world, fitting, saved);
    let mut cloth = world.entity_mut(entity);
    if let Some(mut sewn) = cloth.get_mut::<SewnCloth>() {
        sewn.progress.clone_from(&saved.seams);
    }
    saved.surface.show(&mut cloth, &fitting.levels);
    let activity = cloth.get::<ClothInstance>().map(ClothInstance::published_activity);
    if let (Some(mut state), Some(activity)) = (cloth.get_mut::<ClothState>(), activity) {
        state.activity = activity;
        state.scale = saved.growth.end();
    }
}

fn leave_lane(world: &mut World, entity: Entity) {
    world.resource_scope(|world, mut batches: Mut<ClothBatches>| {
        if let Some(mut instance) = world.get_mut::<ClothInstance>(entity) {
            instance.leave_lane(&mut batches);
        }
    });
}

fn restore_instance(world: &mut World, fitting: &Fitting, saved: &SavedCloth) {
    let mut cloth = world.entity_mut(fitting.entity);
    let entity = cloth.id();
    let target = cloth.get::<Attachment>().map(|it| it.target_other_than(entity).unwrap_or(entity));
    let lods = cloth.get::<LodSet>().filter(|lods| lods.validate(entity).is_ok()).cloned();
    let resolution = cloth.get::<ClothResolution>().copied().unwrap_or_default();
    let has_regions = cloth.contains::<ClothRegions>();
    let was_frozen = cloth.get::<ClothInstance>().is_some_and(|instance| instance.frozen);
    let Some(mut instance) = cloth.get_mut::<ClothInstance>() else { return };
    let rest = fitting.levels.fabric(0).rest_positions();
    *instance = ClothInstance {
        levels: Some(Arc::clone(&fitting.levels)),
        lods: lods.unwrap_or_default(),
        resolution,
        has_regions,
        level: saved.level,
        rest_middle: rest.get(rest.len() / 2).copied().unwrap_or_default(),
        storage: StateStorage::from(saved.state.clone()),
        seed: saved.seed,
        unmoved: saved.unmoved,
        scale: fitting.scale,
        activity: saved.activity,
        material: saved.material,
        gravity: saved.gravity,
        inertia: saved.inertia,
        growth: saved.growth,
        target,
        target_lost: saved.target_lost,
        frozen: saved.frozen,
        taking_up: saved.taking_up.clone(),
        is_posed: saved.is_posed,
        restored: Some(Box::new(Restored {
            pending: saved.pending,
            touches: saved.touches,
            ..Restored::default()
        })),
        ..ClothInstance::default()
    };
    if let Some(mut material) = cloth.get_mut::<ClothMaterial>()
        && material.0 != saved.material
    {
        material.set_changed();
    }
    match (was_frozen, saved.frozen) {
        (false, true) => _ = cloth.insert(ClothPaused),
        (true, false) => _ = cloth.remove::<ClothPaused>(),
        _ => {}
    }
}

/// Restores what is known of the cloth's frame, of its anchors and of what it did to them.
fn restore_motion(world: &mut World, entity: Entity, saved: &SavedCloth, now: &ObservationTimes) {
    let mut cloth = world.entity_mut(entity);
    if let Some(mut frame) = cloth.get_mut::<PoseHistory>() {
        *frame = saved.frame.clone();
        frame.move_times(&saved.times, now);
    }
    let anchors = cloth.get::<Attachment>().map(|attachment| &attachment.anchors);
    let anchors = anchors.filter(|anchors| !anchors.is_empty());
    let breaks = anchors
        .is_some_and(|anchors| anchors.iter().any(|anchor| anchor.break_force < f32::INFINITY));
    if let Some(mut poses) = anchors.map(|it| AnchorPoses::restored(it, &saved.anchors)) {
        poses.move_times(&saved.times, now);
        cloth.insert((poses, AnchorPins::default()));
    }
    if breaks && saved.reactions.is_some() {
        cloth.insert_if_new(AnchorReactions::default());
    }
    if let Some(mut known) = cloth.get_mut::<AnchorReactions>() {
        // Those that were asked for later knew of nothing then.
        let saved = saved.reactions.as_ref();
        known.target = saved.map(|it| it.target).unwrap_or_default();
        known.anchors = saved.map(|it| it.anchors.clone()).unwrap_or_default();
    }
}

fn restore_skin(world: &mut World, fitting: &Fitting, saved: &SavedCloth, now: &ObservationTimes) {
    let Some(SavedSkin { joints, matrices }) = &saved.skin else { return };
    let entity = fitting.entity;
    let has_news = News::of(world).is_some_and(|news| {
        news.has::<ClothSkin>(entity)
            || news.has::<SkinLimits>(entity)
            || news.has::<ClothMesh>(entity)
    });
    let mut cloth = world.entity_mut(entity);
    if has_news || !cloth.contains::<SkinnedParticles>() {
        let led = cloth.get::<ClothMesh>().zip(cloth.get::<ClothSkin>());
        let led = led.and_then(|(mesh, skin)| led_by(mesh, skin, cloth.get::<SkinLimits>()));
        let Some(led) = led else { return };
        cloth.insert(led);
    }
    let Some(mut poses) = cloth.get_mut::<JointPoses>() else { return };
    poses.restore(joints);
    poses.move_times(&saved.times, now);
    let ends = poses.matrices();
    if let Some(mut particles) = cloth.get_mut::<SkinnedParticles>() {
        particles.restore(&fitting.levels, saved.level, matrices.clone(), ends);
    }
}

/// Restores the cloth's substeps, its record in the choice of levels, and its rest.
fn restore_choices(world: &mut World, fitting: &Fitting, saved: &SavedCloth) {
    let gravity = world.resource::<ClothSettings>().gravity.length();
    let mut selector = world.resource_mut::<LevelSelector>();
    let class = saved.effort.class();
    let record = saved.record.as_ref().map(|record| {
        let table = selector.tables.index_of(&fitting.levels, class);
        let of_levels = (table, selector.tables.radius(table));
        LodRecord::restored(&fitting.levels, of_levels, record, selector.tick)
    });
    let limits = world.resource::<ClothSettings>().limits(saved.level);
    let fabric = fitting.levels.fabric(saved.level);
    let acceleration = class.acceleration(gravity) / saved.growth.end();
    let needed = limits.of_fabric(fabric, saved.tick, acceleration);
    let mut cloth = world.entity_mut(fitting.entity);
    if let Some(mut effort) = cloth.get_mut::<ClothEffort>() {
        *effort = saved.effort.clone();
    }
    if let Some(mut known) = cloth.get_mut::<LodRecord>() {
        *known = record.unwrap_or_default();
    }
    if let Some(mut timer) = cloth.get_mut::<RestTimer>() {
        *timer = RestTimer {
            ticks: saved.rest_ticks,
            places: saved.rest_places.clone(),
            group: None,
            pose: saved.rest_pose,
            rounding: saved.rest_rounding,
        };
    }
    // Other settings than those of the saved world: the cloth gets the substeps that it needs here.
    if saved.in_lane
        && needed != saved.effort.needed
        && let Some(mut instance) = cloth.get_mut::<ClothInstance>()
        && let Some(restored) = &mut instance.restored
    {
        restored.pending.lanes = true;
    }
}
