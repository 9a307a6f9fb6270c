//! Cloth in an app to which no plugin of cloth was added.

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_time::{Time, Virtual};

use crate::batch::batches::ClothBatches;

/// Whether it was told that the plugins are missing.
#[derive(Resource)]
struct Told;

/// Logs, once, that nothing simulates a cloth. Worlds without a clock, as those of scenes and of tests, are no apps that run.
pub(super) fn tell_missing_plugins(mut world: DeferredWorld, context: HookContext) {
    let runs = world.contains_resource::<Time<Virtual>>();
    if !runs || world.contains_resource::<ClothBatches>() || world.contains_resource::<Told>() {
        return;
    }
    log::error!(
        "cloth {} is not simulated: this app has no ClothPlugins; add ClothPlugins::default() before cloth is spawned",
        context.entity
    );
    world.commands().insert_resource(Told);
}
