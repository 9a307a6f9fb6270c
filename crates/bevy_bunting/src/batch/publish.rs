//! Writes the state of each cloth after a tick to its [`ClothState`].

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::lod::effort::ClothEffort;
use crate::schedule::{ClothSystems, ClothTick};

/// Publishes the state of cloths.
#[derive(Debug, Default)]
pub struct PublishPlugin;

impl Plugin for PublishPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            (stop_states, publish_states, reset_diverged).chain().in_set(ClothSystems::Publish),
        )
        .init_resource::<Diverged>();
    }
}

/// Cloths whose positions were not finite after this tick.
#[derive(Resource, Debug, Default)]
pub(crate) struct Diverged(Vec<Entity>);

/// Publishes the activity of cloths. A cloth that is no longer simulated gets a previous surface equal to the
/// current one, so that its display stands still.
fn stop_states(mut cloths: Query<(&ClothInstance, &mut ClothState), Changed<ClothInstance>>) {
    for (instance, mut state) in &mut cloths {
        state.activity = instance.published_activity();
        if instance.lane().is_none() && state.moved {
            let state = &mut *state;
            state.moved = false;
            state.previous_positions.clone_from(&state.positions);
            state.previous_normals.clone_from(&state.normals);
        }
    }
}

/// Copies surfaces batch by batch, as the lanes of a batch lie side by side in memory. The buffers of each lane and of
/// the cloth's two surfaces are exchanged in turn, so that nothing is allocated.
pub(crate) fn publish_states(
    mut cloths: Query<(&mut ClothState, &mut ClothEffort)>,
    mut batches: ResMut<ClothBatches>,
    mut diverged: ResMut<Diverged>,
    time: Res<Time>,
) {
    let tick = time.delta_secs();
    batches.copy_surfaces();
    for (entity, surface) in batches.surfaces() {
        let Ok((mut state, mut effort)) = cloths.get_mut(entity) else { continue };
        let state = &mut *state;
        core::mem::swap(&mut state.previous_positions, &mut state.positions);
        core::mem::swap(&mut state.positions, &mut surface.positions);
        core::mem::swap(&mut state.previous_normals, &mut state.normals);
        core::mem::swap(&mut state.normals, &mut surface.normals);
        state.blend();
        state.moved = true;
        (state.motion, state.tick) = (effort.motion(), tick);
        effort.note_tick(surface, state.scale);
        if !surface.is_finite {
            diverged.0.push(entity);
        }
    }
}

/// Resets cloths with positions that are not finite to their rest shape, and reports them.
pub(crate) fn reset_diverged(
    mut cloths: Query<(&mut ClothInstance, &mut ClothState)>,
    mut batches: ResMut<ClothBatches>,
    mut diverged: ResMut<Diverged>,
    mut commands: Commands,
) {
    for entity in diverged.0.drain(..) {
        let Ok((mut instance, mut state)) = cloths.get_mut(entity) else { continue };
        if instance.lane().is_some() {
            instance.reset(&mut state, &mut batches);
            ClothFailed::report(&mut commands, entity, ClothError::Diverged { entity });
        }
    }
}
