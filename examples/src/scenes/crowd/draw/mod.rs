//! Draws the plaza: stage, masts and coloured cloth.

mod budget;
mod colours;
mod masts;

use std::f32::consts::FRAC_PI_3;

use crate::render::stage::Stage;
use bevy::prelude::*;

/// The plaza at noon.
pub const STAGE: Stage = Stage {
    ground: Color::srgb(0.52, 0.50, 0.46),
    extent: 2000.0,
    haze: [100.0, 700.0],
    field_of_view: FRAC_PI_3,
    sun: Vec3::new(-1.0, 1.0, 0.55),
    cascades: 2,
    shadows: [20.0, 80.0],
};

/// Draws masts and cloths, coloured by level at the start or not.
pub fn plugin(by_level: bool) -> impl Plugin {
    move |app: &mut App| {
        app.add_plugins((masts::plugin, colours::plugin(by_level)));
    }
}

/// Adds keys: arrows change the budget, L colours cloth by level.
pub fn control(app: &mut App) {
    app.add_plugins((budget::plugin, colours::control));
}
