//! Writes what the tick brought to [`ClothState`].

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::{ClothError, ClothFailed};
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::schedule::{ClothSystems, ClothTick};

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

/// Surfaces are copied batch by batch, as the lanes of a batch lie side by side in memory, into the
/// memory of what was shown before the last tick.
pub(crate) fn publish_states(
    mut instances: Query<&mut ClothInstance>,
    mut cloths: Query<&mut ClothState>,
    mut batches: ResMut<ClothBatches>,
    mut diverged: Local<Vec<Entity>>,
    mut commands: Commands,
) {
    for (entity, surface) in batches.surfaces() {
        if let Ok(mut state) = cloths.get_mut(entity) {
            surface.positions = core::mem::take(&mut state.previous_positions);
            surface.normals = core::mem::take(&mut state.previous_normals);
        }
    }
    batches.copy_surfaces();
    for (entity, surface) in batches.surfaces() {
        if let Ok(mut state) = cloths.get_mut(entity) {
            let state = &mut *state;
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
    for entity in diverged.drain(..) {
        let (Ok(mut instance), Ok(mut state)) = (instances.get_mut(entity), cloths.get_mut(entity))
        else {
            continue;
        };
        if instance.slot().is_some() && instance.put_to_rest(&mut state, &mut batches) {
            ClothFailed::report(&mut commands, entity, ClothError::Diverged { entity });
        }
    }
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
