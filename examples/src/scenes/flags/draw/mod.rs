//! Draws the scene: stage, roads, poles, vehicles and printed flags.

mod poles;
mod road;
mod vehicles;

use std::f32::consts::FRAC_PI_4;

use crate::View;
use crate::render::stage::{self, Stage};
use crate::render::{self, print};
use bevy::prelude::*;
use bunting_scenes::Track;

/// A meadow in the morning.
pub const STAGE: Stage = Stage {
    ground: Color::srgb(0.33, 0.37, 0.24),
    extent: 2000.0,
    haze: [100.0, 700.0],
    field_of_view: FRAC_PI_4,
    sun: Vec3::new(-1.0, 1.0, 0.55),
    cascades: 3,
    shadows: [25.0, 140.0],
};

/// Distance of the camera from the centre of its orbit at the start, m.
const DISTANCE: f32 = 24.0;

/// Draws roads, poles and vehicles, and prints the flags.
pub fn plugin(app: &mut App) {
    app.add_plugins((
        road::plugin,
        poles::plugin,
        vehicles::plugin,
        print::plugin(stage::flag_cloth()),
    ));
}

/// Removes the viewer from its track, so that the mouse can move it, and adds keys.
pub fn control(app: &mut App, centre: Vec3) {
    let viewer = render::viewer(app);
    app.world_mut().entity_mut(viewer).remove::<Track>();
    render::control_orbit(app, View { eye: centre + DISTANCE * Vec3::Z, centre });
}
