//! Wind that keys change.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::render::title::Title;

/// Factor of the wind's speed for one press of a key.
const STEP: f32 = 1.25;

/// Least and greatest factor of the wind's speed in the scene.
const FACTORS: (f32, f32) = (0.25, 4.0);

/// Factor of the wind's speed in the scene.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
struct WindFactor {
    factor: f32,
    off: bool,
}

/// A wind before any key changed it.
#[derive(Component, Clone, Copy, Debug)]
struct SceneWind(WindField);

/// The arrows up and down make the wind stronger and weaker; W turns it off and on.
pub fn plugin(app: &mut App) {
    app.insert_resource(WindFactor { factor: 1.0, off: false })
        .add_systems(PostStartup, keep_scene_winds)
        .add_systems(
            Update,
            (read_keys, scale_winds.run_if(resource_changed::<WindFactor>)).chain(),
        );
    Title::add_keys(app, "↑ ↓ W: wind");
}

fn keep_scene_winds(mut commands: Commands, winds: Query<(Entity, &WindField)>) {
    for (wind, field) in &winds {
        commands.entity(wind).insert(SceneWind(*field));
    }
}

fn read_keys(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<WindFactor>) {
    if keys.just_pressed(KeyCode::ArrowUp) {
        wind.factor = (wind.factor * STEP).min(FACTORS.1);
    }
    if keys.just_pressed(KeyCode::ArrowDown) {
        wind.factor = (wind.factor / STEP).max(FACTORS.0);
    }
    if keys.just_pressed(KeyCode::KeyW) {
        wind.off = !wind.off;
    }
}

fn scale_winds(
    mut winds: Query<(&mut WindField, &SceneWind)>,
    wind: Res<WindFactor>,
    mut title: ResMut<Title>,
) {
    let factor = if wind.off { 0.0 } else { wind.factor };
    title.note = format!("wind × {factor:.2}");
    for (mut field, SceneWind(scene)) in &mut winds {
        field.velocity = factor * scene.velocity;
        field.gust_strength = factor * scene.gust_strength;
    }
}
