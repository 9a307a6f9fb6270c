//! Wind that keys change.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// How many times stronger the wind becomes by one press of a key.
const STEP: f32 = 1.25;

/// How many times stronger than in the scene the wind may become.
const STRONGEST: f32 = 4.0;

/// How many times weaker than in the scene the wind may become.
const WEAKEST: f32 = 0.25;

/// How the wind differs from that of the scene.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Weather {
    strength: f32,
    calm: bool,
}

impl Weather {
    /// How many times stronger than in the scene the wind is.
    pub fn factor(self) -> f32 {
        if self.calm { 0.0 } else { self.strength }
    }
}

/// A wind as it is in the scene.
#[derive(Component, Clone, Copy, Debug)]
struct Forecast(WindField);

/// The arrows up and down make the wind stronger and weaker, W turns it off and on.
pub fn plugin(app: &mut App) {
    app.insert_resource(Weather { strength: 1.0, calm: false })
        .add_systems(PostStartup, forecast)
        .add_systems(Update, (change, blow.run_if(resource_changed::<Weather>)).chain());
}

fn forecast(mut commands: Commands, winds: Query<(Entity, &WindField)>) {
    for (wind, field) in &winds {
        commands.entity(wind).insert(Forecast(*field));
    }
}

fn change(keys: Res<ButtonInput<KeyCode>>, mut weather: ResMut<Weather>) {
    if keys.just_pressed(KeyCode::ArrowUp) {
        weather.strength = (weather.strength * STEP).min(STRONGEST);
    }
    if keys.just_pressed(KeyCode::ArrowDown) {
        weather.strength = (weather.strength / STEP).max(WEAKEST);
    }
    if keys.just_pressed(KeyCode::KeyW) {
        weather.calm = !weather.calm;
    }
}

fn blow(mut winds: Query<(&mut WindField, &Forecast)>, weather: Res<Weather>) {
    for (mut wind, Forecast(usual)) in &mut winds {
        wind.velocity = weather.factor() * usual.velocity;
        wind.gust_strength = weather.factor() * usual.gust_strength;
    }
}
