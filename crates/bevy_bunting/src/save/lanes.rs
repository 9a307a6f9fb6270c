//! Gives restored cloths the lanes that they had, and marks what was restored.

use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;
use crate::batch::occupancy::PendingCloth;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::cloth::restored::RestoredAt;
use crate::lod::effort::ClothEffort;
use crate::lod::sleep::Changes;
use crate::motion::pose::PoseHistory;
use crate::save::cloth::SavedCloth;
use crate::save::plugin::Restorations;
use crate::settings::ClothSettings;

/// Puts restored cloths that had lanes into lanes.
pub(super) fn enter_lanes<'a>(
    world: &mut World,
    cloths: impl IntoIterator<Item = (Entity, &'a SavedCloth)>,
) {
    let cloths = cloths.into_iter().filter(|(_, saved)| saved.in_lane);
    let cloths: Vec<(Entity, &SavedCloth)> = cloths.collect();
    let lanes = world.resource::<ClothSettings>().lanes;
    let mut assigned: Vec<(Entity, LaneHandle)> = Vec::new();
    world.resource_scope(|world, mut batches: Mut<ClothBatches>| {
        for &(entity, _) in &cloths {
            let mut cloth = world.entity_mut(entity);
            let Some(steps) = cloth.get::<ClothEffort>().map(|effort| effort.settings) else {
                continue;
            };
            let Some(mut instance) = cloth.get_mut::<ClothInstance>() else { continue };
            let Some(fabric) = instance.fabric().cloned() else { continue };
            if let StateStorage::Snapshot(snapshot) = core::mem::take(&mut instance.storage) {
                let material = instance.acting_material();
                let snapshot = *snapshot;
                batches.add(&fabric, steps, PendingCloth { entity, fabric: 0, snapshot, material });
            }
        }
        batches.assign_lanes(lanes, |entity, lane| assigned.push((entity, lane)));
    });
    for (entity, lane) in assigned {
        if let Some(mut instance) = world.get_mut::<ClothInstance>(entity) {
            // Of other cloths no more changes than their place.
            let instance = instance.bypass_change_detection();
            instance.storage = StateStorage::Lane(lane);
            instance.unmoved = false;
        }
    }
    world.resource_scope(|world, mut batches: Mut<ClothBatches>| {
        for (entity, saved) in cloths {
            let lane = world.get::<ClothInstance>(entity).and_then(ClothInstance::lane);
            if let (Some(lane), Some(reactions)) = (lane, &saved.reactions) {
                batches.lane(lane).set_pin_velocities(reactions.pin_velocities.clone());
            }
        }
    });
}

/// Marks entities as restored now: what was changed before is no change since the last tick.
pub(super) fn mark(world: &mut World, entities: impl IntoIterator<Item = Entity>) {
    let at = RestoredAt::new(world.change_tick());
    world.increment_change_tick();
    for entity in entities {
        let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
        if let Some(mut history) = entity.get_mut::<PoseHistory>() {
            history.bypass_change_detection().note_restored(at);
        }
        if let Some(mut instance) = entity.get_mut::<ClothInstance>()
            && let Some(restored) = &mut instance.bypass_change_detection().restored
        {
            restored.at = at;
        }
    }
    world.resource_mut::<Changes>().count_again();
    world.resource_mut::<Restorations>().since_last_tick = true;
}
