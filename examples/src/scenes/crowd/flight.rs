//! The viewer's flight: round the plaza, looking ahead and inwards.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Radius of the path, m; that of the plaza is 57 m.
const RADIUS: f32 = 40.0;

/// Height, m.
const HEIGHT: f32 = 5.0;

/// Speed, m/s.
const SPEED: f32 = 10.0;

/// Angle between the directions of view and of flight, inwards, rad.
const INWARDS: f32 = 0.4;

/// Downward slope of the direction of view.
const DOWN: f32 = 0.12;

/// Time of one round, s.
pub const ROUND: f64 = (std::f32::consts::TAU * RADIUS / SPEED) as f64;

/// The pose of the viewer at a time (s).
pub fn pose(time: f32) -> Transform {
    let angle = SPEED / RADIUS * time;
    let position = Vec3::new(RADIUS * angle.cos(), HEIGHT, RADIUS * angle.sin());
    let course = Vec3::new(-angle.sin(), -DOWN, angle.cos());
    let direction = Quat::from_rotation_y(-INWARDS) * course;
    Transform::from_translation(position).looking_to(direction, Vec3::Y)
}

/// Moves the viewer.
pub fn fly(mut viewers: Query<&mut Transform, With<LodViewer>>, time: Res<Time>) {
    for mut transform in &mut viewers {
        *transform = pose(time.elapsed_secs());
    }
}
