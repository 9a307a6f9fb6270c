//! The system that eases displayed surfaces across changes of level.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::publish::reset_diverged;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::display::easing::ClothEasing;
use crate::display::surface::ClothSurface;
use crate::schedule::{ClothSystems, ClothTick};

/// Eases displayed surfaces across changes of level.
#[derive(Debug, Default)]
pub struct EasingPlugin;

impl Plugin for EasingPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            ease_surfaces.in_set(ClothSystems::Publish).after(reset_diverged),
        );
    }
}

pub(crate) fn ease_surfaces(
    mut cloths: Query<(&ClothInstance, &mut ClothState, &mut ClothEasing), With<ClothSurface>>,
    time: Res<Time>,
) {
    let tick = time.delta_secs();
    for (instance, mut state, mut easing) in &mut cloths {
        if easing.is_active() {
            easing.keep_only_for(instance.levels.as_ref());
        }
        let Some(levels) = &instance.levels else { continue };
        if state.replaced.is_some() {
            let replaced = state.bypass_change_detection().replaced.take();
            replaced.into_iter().for_each(|it| easing.begin(it, levels, &state, tick));
        }
        if easing.is_active() {
            easing.advance(levels, &state, tick);
        }
    }
}

#[cfg(test)]
#[path = "ease_tests.rs"]
mod tests;
