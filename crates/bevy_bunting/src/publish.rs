//! Writes what the tick brought to [`ClothState`].

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::batches::ClothBatches;
use crate::error::{ClothError, ClothFailed};
use crate::instance::ClothInstance;
use crate::schedule::{ClothSystems, ClothTick};
use crate::state::ClothState;

/// Publishes the state of cloths.
#[derive(Debug, Default)]
pub struct PublishPlugin;

impl Plugin for PublishPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(ClothTick, publish_states.in_set(ClothSystems::Publish));
    }
}

pub(crate) fn publish_states(
    mut cloths: Query<(Entity, &ClothInstance, &mut ClothState)>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    for (entity, instance, mut state) in &mut cloths {
        if state.activity != instance.activity {
            state.activity = instance.activity;
        }
        let Some(slot) = instance.slot() else {
            // What stands still is not between two places.
            if state.moved {
                let state = &mut *state;
                state.moved = false;
                state.previous_positions.clone_from(&state.positions);
                state.previous_normals.clone_from(&state.normals);
            }
            continue;
        };
        let (batch, lane) = batches.at(slot);
        let ClothState { positions, previous_positions, normals, previous_normals, moved, .. } =
            &mut *state;
        *moved = true;
        core::mem::swap(positions, previous_positions);
        core::mem::swap(normals, previous_normals);
        batch.copy_positions(lane, positions);
        batch.copy_normals(lane, normals);
        if !is_finite(positions) {
            batches.lane(slot).rest();
            let fabric = instance.fabric().expect("a cloth in a lane has a fabric");
            state.begin(instance.level, fabric, fabric.rest_positions());
            ClothFailed::report(&mut commands, entity, ClothError::Diverged { entity });
        }
    }
}

/// Whether all are finite: what is not makes the sum so. Velocities come from positions.
fn is_finite(positions: &[Vec3]) -> bool {
    // Short sums do not wait for one another.
    let sums = positions.chunks(8).map(|chunk| chunk.iter().sum::<Vec3>());
    sums.sum::<Vec3>().is_finite()
}
