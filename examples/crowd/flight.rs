//! The camera's flight: round the plaza, looking ahead and inwards.

use bevy::prelude::*;

/// Radius of the path, m: of the plaza's 57.
const RADIUS: f32 = 40.0;

/// Height, m.
const HEIGHT: f32 = 5.0;

/// Speed, m/s.
const SPEED: f32 = 10.0;

/// By how much it looks inwards, rad.
const INWARDS: f32 = 0.4;

/// By how much it looks down: metres a metre.
const DOWN: f32 = 0.12;

/// Time once round, s.
pub const ROUND: f64 = (std::f32::consts::TAU * RADIUS / SPEED) as f64;

/// Flies.
#[derive(Component, Clone, Copy, Debug)]
pub struct Pilot;

/// Where the camera is after so many seconds.
pub fn pose(seconds: f32) -> Transform {
    let angle = SPEED / RADIUS * seconds;
    let at = Vec3::new(RADIUS * angle.cos(), HEIGHT, RADIUS * angle.sin());
    let course = Vec3::new(-angle.sin(), -DOWN, angle.cos());
    Transform::from_translation(at).looking_to(Quat::from_rotation_y(-INWARDS) * course, Vec3::Y)
}

/// Moves the camera.
pub fn fly(mut pilots: Query<&mut Transform, With<Pilot>>, time: Res<Time>) {
    for mut place in &mut pilots {
        *place = pose(time.elapsed_secs());
    }
}
