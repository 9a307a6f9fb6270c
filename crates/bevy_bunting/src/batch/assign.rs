//! Every cloth takes its lane.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::batch::occupancy::Newcomer;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::{ClothInstance, Place};
use crate::cloth::mesh::ClothPaused;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Seats cloths in batches.
#[derive(Debug, Default)]
pub struct SeatPlugin;

impl Plugin for SeatPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothSettings>()
            .register_type::<ClothPaused>()
            .init_resource::<ClothSettings>()
            .init_resource::<ClothBatches>()
            .add_observer(note_pause)
            .add_observer(note_end_of_pause)
            .add_systems(ClothTick, seat_cloths.in_set(ClothSystems::SelectLod));
    }
}

fn note_pause(paused: On<Insert, ClothPaused>, mut cloths: Query<&mut ClothInstance>) {
    if let Ok(mut instance) = cloths.get_mut(paused.entity) {
        instance.set_changed();
    }
}

fn note_end_of_pause(goes_on: On<Remove, ClothPaused>, mut cloths: Query<&mut ClothInstance>) {
    if let Ok(mut instance) = cloths.get_mut(goes_on.entity) {
        instance.set_changed();
    }
}

/// Seats those that wait, takes out those that are paused or asleep, and everyone when the settings or
/// the length of a tick change.
pub(crate) fn seat_cloths(
    mut cloths: Query<(Entity, &mut ClothInstance, Has<ClothPaused>)>,
    settings: Res<ClothSettings>,
    time: Res<Time>,
    mut last_tick: Local<f32>,
    mut batches: ResMut<ClothBatches>,
) {
    let tick = time.delta_secs();
    let all_anew = settings.is_changed() || tick != *last_tick;
    *last_tick = tick;
    let gravity = settings.gravity.length();
    for (entity, mut instance, paused) in &mut cloths {
        // Most stay where they are.
        if !instance.is_changed() && !all_anew {
            continue;
        }
        let still = paused || instance.activity != ClothActivity::Ticking;
        if instance.slot().is_some() && (still || all_anew) {
            instance.unseat(&mut batches);
        }
        if still || instance.waiting().is_none() {
            continue;
        }
        if let (Some(fabric), Place::Waiting(snapshot)) =
            (instance.fabric().cloned(), core::mem::take(&mut instance.place))
        {
            let newcomer = Newcomer { entity, snapshot, material: instance.material };
            let limits = settings.limits(instance.level);
            batches.add(&fabric, limits.of_fabric(&fabric, tick, gravity), newcomer);
        }
    }
    batches.settle(settings.lanes, |entity, slot| {
        if let Ok((_, mut instance, _)) = cloths.get_mut(entity) {
            instance.place = Place::Seated(slot);
            instance.unmoved = false;
        }
    });
}
