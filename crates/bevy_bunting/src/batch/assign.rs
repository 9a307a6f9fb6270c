//! Assigns lanes: each simulated cloth gets a lane, paused and sleeping cloths leave theirs.

use core::ops::RangeInclusive;

use bevy_app::{App, Plugin};
use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemChangeTick;
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::batch::choose_substeps::{SteppedCloth, choose_substeps};
use crate::batch::lane_handle::LaneHandle;
use crate::batch::occupancy::PendingCloth;
use crate::batch::shared_substeps::Member;
use crate::cloth::activity::{ClothActivity, ClothPaused};
use crate::cloth::instance::{ClothInstance, StateStorage, has_changed};
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// The tick in which lanes were last assigned.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct LastAssignment {
    /// Its length, s; zero before the first.
    pub tick: f32,
    /// The settings in it.
    pub settings: Option<ClothSettings>,
    /// When it was, as a tick of change.
    pub ran: Tick,
}

/// Assigns cloths to lanes of batches.
#[derive(Debug, Default)]
pub struct LanePlugin;

impl Plugin for LanePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothSettings>()
            .register_type_data::<RangeInclusive<u32>, ReflectSerialize>()
            .register_type_data::<RangeInclusive<u32>, ReflectDeserialize>()
            .register_type::<ClothPaused>()
            .init_resource::<ClothSettings>()
            .init_resource::<ClothBatches>()
            .init_resource::<LastAssignment>()
            .add_observer(mark_paused)
            .add_observer(mark_resumed)
            .add_systems(ClothTick, assign_lanes.in_set(ClothSystems::SelectLod));
    }
}

fn mark_paused(paused: On<Insert, ClothPaused>, mut cloths: Query<&mut ClothInstance>) {
    if let Ok(mut instance) = cloths.get_mut(paused.entity) {
        instance.set_changed();
    }
}

fn mark_resumed(resumed: On<Remove, ClothPaused>, mut cloths: Query<&mut ClothInstance>) {
    if let Ok(mut instance) = cloths.get_mut(resumed.entity) {
        instance.set_changed();
    }
}

/// Chooses the substeps of cloths, moves snapshots of simulated cloths into lanes, and states of paused and sleeping cloths
/// out of lanes. A cloth whose substeps have changed moves to another batch. When the settings or the length of a
/// tick change, all cloths are assigned again, as their numbers of substeps may differ.
pub(crate) fn assign_lanes(
    mut cloths: Query<SteppedCloth>,
    settings: Res<ClothSettings>,
    time: Res<Time>,
    (mut last, change_tick): (ResMut<LastAssignment>, SystemChangeTick),
    mut members: Local<Vec<Member>>,
    mut batches: ResMut<ClothBatches>,
) {
    let tick = time.delta_secs();
    let has_new_settings = last.settings.as_ref() != Some(&*settings);
    // Before the first tick no cloth has a lane that it does not keep.
    let reassign_all = last.settings.is_some() && (has_new_settings || tick != last.tick);
    if has_new_settings {
        last.settings = Some(settings.clone());
    }
    (last.tick, last.ran) = (tick, change_tick.this_run());
    if choose_substeps(&mut cloths, &settings, tick, reassign_all, &batches, &mut members) {
        for (entity, mut instance, effort, paused, _) in &mut cloths {
            let steps = effort.settings;
            let differs = |lane: LaneHandle| batches.settings(lane) != steps;
            let is_changed = has_changed(&instance, |pending| pending.lanes) || reassign_all;
            if !is_changed && !instance.lane().is_some_and(differs) {
                continue;
            }
            let is_still = paused || instance.activity != ClothActivity::Ticking;
            let Some(fabric) = instance.fabric().cloned() else { continue };
            let moves = |lane: LaneHandle| is_still || reassign_all || differs(lane);
            let leaves = instance.lane().is_some_and(moves);
            let enters = !is_still && (leaves || instance.snapshot().is_some());
            // Substeps that follow from other cloths are no change of this one.
            if is_changed && (leaves || enters) {
                instance.set_changed();
            }
            let instance = instance.bypass_change_detection();
            if leaves {
                instance.leave_lane(&mut batches);
            }
            if !enters {
                continue;
            }
            if let StateStorage::Snapshot(snapshot) = core::mem::take(&mut instance.storage) {
                let pending = PendingCloth {
                    entity,
                    fabric: 0,
                    snapshot: *snapshot,
                    material: instance.acting_material(),
                };
                batches.add(&fabric, steps, pending);
            }
        }
    }
    batches.assign_lanes(settings.lanes, |entity, lane| {
        if let Ok((_, mut instance, ..)) = cloths.get_mut(entity) {
            // A new lane must not mark the cloth as changed, since it depends on other cloths.
            let instance = instance.bypass_change_detection();
            instance.storage = StateStorage::Lane(lane);
            instance.unmoved = false;
        }
    });
}
