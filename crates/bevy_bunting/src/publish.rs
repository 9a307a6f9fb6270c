//! Writes what the tick brought to [`ClothState`].

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bunting_solver::{LaneCount, LaneSurface};

use crate::batches::{ClothBatches, Seat};
use crate::error::{ClothError, ClothFailed};
use crate::instance::ClothInstance;
use crate::schedule::{ClothSystems, ClothTick};
use crate::state::ClothState;

/// Publishes the state of cloths.
#[derive(Debug, Default)]
pub struct PublishPlugin;

impl Plugin for PublishPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            (still_states, publish_states).chain().in_set(ClothSystems::Publish),
        );
    }
}

/// Batch by batch: the lanes of a batch lie side by side in memory.
pub(crate) fn publish_states(
    instances: Query<&ClothInstance>,
    mut cloths: Query<&mut ClothState>,
    mut batches: ResMut<ClothBatches>,
    mut surfaces: Local<Vec<LaneSurface>>,
    mut diverged: Local<Vec<Entity>>,
    mut commands: Commands,
) {
    surfaces.resize(LaneCount::Sixteen.get(), LaneSurface::default());
    for (batch, entities) in batches.all() {
        let places = || surfaces_of(entities);
        for (lane, entity) in places() {
            if let Ok(mut state) = cloths.get_mut(entity) {
                // What was shown before the last tick is overwritten, in its own memory.
                let surface = &mut surfaces[lane];
                surface.positions = core::mem::take(&mut state.previous_positions);
                surface.normals = core::mem::take(&mut state.previous_normals);
            }
        }
        batch.copy_surfaces(&mut surfaces);
        for (lane, entity) in places() {
            if let Ok(mut state) = cloths.get_mut(entity) {
                let (state, surface) = (&mut *state, &mut surfaces[lane]);
                let positions = core::mem::take(&mut surface.positions);
                let normals = core::mem::take(&mut surface.normals);
                state.previous_positions = core::mem::replace(&mut state.positions, positions);
                state.previous_normals = core::mem::replace(&mut state.normals, normals);
                state.blend();
                state.moved = true;
                if !surface.is_finite {
                    diverged.push(entity);
                }
            }
        }
    }
    for entity in diverged.drain(..) {
        let (Ok(instance), Ok(mut state)) = (instances.get(entity), cloths.get_mut(entity)) else {
            continue;
        };
        if let (Some(slot), Some(levels)) = (instance.slot(), &instance.levels) {
            batches.lane(slot).rest();
            let rest = levels.fabric(instance.level).rest_positions();
            state.begin_anew(instance.level, levels, rest);
            ClothFailed::report(&mut commands, entity, ClothError::Diverged { entity });
        }
    }
}

fn surfaces_of(seats: &[Option<Seat>]) -> impl Iterator<Item = (usize, Entity)> {
    seats.iter().enumerate().filter_map(|(lane, seat)| Some((lane, seat.as_ref()?.0)))
}

/// What stands still is not between two places.
fn still_states(mut cloths: Query<(&ClothInstance, &mut ClothState), Changed<ClothInstance>>) {
    for (instance, mut state) in &mut cloths {
        state.activity = instance.activity;
        if instance.slot().is_none() && state.moved {
            let state = &mut *state;
            state.moved = false;
            state.previous_positions.clone_from(&state.positions);
            state.previous_normals.clone_from(&state.normals);
        }
    }
}
