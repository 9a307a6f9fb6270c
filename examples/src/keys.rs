//! Keys that stop time and show what one does not see.

use bevy::prelude::*;
use bevy_bunting::{ClothDebugPlugin, ClothGizmos};

/// All keys of the window.
pub const HELP: &str = "↑ ↓ W: wind, L: levels, D: debug, P: pause";

/// L shows levels of detail; D shows attachments, strain and wind; P stops time.
pub fn plugin(app: &mut App) {
    app.add_plugins(ClothDebugPlugin).add_systems(Update, (show, pause));
}

fn show(keys: Res<ButtonInput<KeyCode>>, mut gizmos: ResMut<GizmoConfigStore>) {
    let (_, shown) = gizmos.config_mut::<ClothGizmos>();
    if keys.just_pressed(KeyCode::KeyL) {
        shown.levels = !shown.levels;
    }
    if keys.just_pressed(KeyCode::KeyD) {
        let on = !shown.strain;
        *shown = ClothGizmos { attachments: on, strain: on, wind: on, ..*shown };
    }
}

fn pause(keys: Res<ButtonInput<KeyCode>>, mut time: ResMut<Time<Virtual>>) {
    if keys.just_pressed(KeyCode::KeyP) {
        if time.is_paused() {
            time.unpause();
        } else {
            time.pause();
        }
    }
}
