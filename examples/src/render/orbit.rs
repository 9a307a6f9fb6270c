//! A camera on an orbit: drag to turn, scroll to change the distance.

use std::f32::consts::FRAC_PI_2;

use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll};
use bevy::prelude::*;

use crate::View;

/// Turn per pixel that the mouse is dragged, rad.
const TURN: f32 = 0.005;

/// Relative change of the distance per step of the wheel.
const ZOOM: f32 = 0.1;

/// Least and greatest distance, m.
const DISTANCES: (f32, f32) = (0.3, 200.0);

/// Least and greatest pitch, rad above the horizon: above the ground, and below the zenith.
const PITCHES: (f32, f32) = (-0.05, FRAC_PI_2 - 0.01);

/// The orbit of a camera.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    centre: Vec3,
    /// Distance from the centre, m.
    distance: f32,
    /// Angle around the vertical from +z, rad.
    yaw: f32,
    /// Angle above the horizon, rad.
    pitch: f32,
}

impl Orbit {
    /// An orbit through the eye of a view around its centre.
    #[must_use]
    pub fn new(View { eye, centre }: View) -> Self {
        let from_centre = eye - centre;
        Self {
            centre,
            distance: from_centre.length(),
            yaw: from_centre.x.atan2(from_centre.z),
            pitch: from_centre.y.atan2(from_centre.xz().length()),
        }
    }
}

/// Moves cameras along their orbits.
pub fn plugin(app: &mut App) {
    app.add_systems(Update, move_cameras);
}

fn move_cameras(
    mut cameras: Query<(&mut Orbit, &mut Transform)>,
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
) {
    for (mut orbit, mut transform) in &mut cameras {
        if buttons.pressed(MouseButton::Left) {
            orbit.yaw -= TURN * motion.delta.x;
            orbit.pitch = (orbit.pitch + TURN * motion.delta.y).clamp(PITCHES.0, PITCHES.1);
        }
        let distance = orbit.distance * (-ZOOM * scroll.delta.y.clamp(-1.0, 1.0)).exp();
        orbit.distance = distance.clamp(DISTANCES.0, DISTANCES.1);
        let rotation = Quat::from_euler(EulerRot::YXZ, orbit.yaw, -orbit.pitch, 0.0);
        let translation = orbit.centre + rotation * (orbit.distance * Vec3::Z);
        *transform = Transform { translation, rotation, ..default() };
    }
}
