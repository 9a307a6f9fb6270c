//! A camera that circles around a point: drag to turn, scroll to come closer.

use std::f32::consts::FRAC_PI_2;

use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll};
use bevy::prelude::*;

/// Radians a pixel that the mouse is dragged.
const TURN: f32 = 0.005;

/// Part of the distance that a step of the wheel covers.
const APPROACH: f32 = 0.1;

/// Nearest and farthest, m.
const DISTANCES: (f32, f32) = (2.0, 200.0);

/// Lowest and highest, rad above the horizon: above the ground, and not past the zenith.
const PITCHES: (f32, f32) = (-0.05, FRAC_PI_2 - 0.01);

/// Where a camera circles.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    centre: Vec3,
    /// m.
    distance: f32,
    /// Around the vertical from +z, rad.
    yaw: f32,
    /// Above the horizon, rad.
    pitch: f32,
}

impl Orbit {
    /// Twenty-four metres from a point, in front of it.
    #[must_use]
    pub const fn around(centre: Vec3) -> Self {
        Self { centre, distance: 24.0, yaw: 0.0, pitch: 0.0 }
    }

    /// Around a point, beginning at another.
    #[must_use]
    pub fn from(eye: Vec3, centre: Vec3) -> Self {
        let away = eye - centre;
        let pitch = away.y.atan2(away.xz().length());
        Self { centre, distance: away.length(), yaw: away.x.atan2(away.z), pitch }
    }
}

/// Moves cameras around their points.
pub fn plugin(app: &mut App) {
    app.add_systems(Update, circle);
}

fn circle(
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
        let distance = orbit.distance * (-APPROACH * scroll.delta.y.clamp(-1.0, 1.0)).exp();
        orbit.distance = distance.clamp(DISTANCES.0, DISTANCES.1);
        let rotation = Quat::from_euler(EulerRot::YXZ, orbit.yaw, -orbit.pitch, 0.0);
        let place = orbit.centre + rotation * (orbit.distance * Vec3::Z);
        *transform = Transform { translation: place, rotation, ..default() };
    }
}
