//! Keys that pause the time and show gizmos.

use bevy::prelude::*;
use bevy_bunting::{ClothDebugPlugin, ClothGizmos};

use crate::render::title::Title;

/// P pauses and resumes time.
pub fn pause(app: &mut App) {
    app.add_systems(Update, |keys: Res<ButtonInput<KeyCode>>, mut time: ResMut<Time<Virtual>>| {
        if keys.just_pressed(KeyCode::KeyP) {
            if time.is_paused() {
                time.unpause();
            } else {
                time.pause();
            }
        }
    });
}

/// L shows levels of detail; D shows attachments, strain and wind.
pub fn gizmos(app: &mut App) {
    app.add_plugins(ClothDebugPlugin).add_systems(Update, show_gizmos);
    Title::add_keys(app, "L: levels, D: debug");
}

fn show_gizmos(keys: Res<ButtonInput<KeyCode>>, mut config: ResMut<GizmoConfigStore>) {
    let (_, gizmos) = config.config_mut::<ClothGizmos>();
    if keys.just_pressed(KeyCode::KeyL) {
        gizmos.levels = !gizmos.levels;
    }
    if keys.just_pressed(KeyCode::KeyD) {
        let on = !gizmos.strain;
        *gizmos = ClothGizmos { attachments: on, strain: on, wind: on, ..*gizmos };
    }
}
