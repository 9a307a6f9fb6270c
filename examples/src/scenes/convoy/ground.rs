//! Rough ground: a heightfield of avian's.

use avian3d::prelude::{Collider, RigidBody};
use bevy::prelude::*;
use bevy_bunting::parry3d::shape::SharedShape;
use bevy_bunting::parry3d::utils::Array2;

/// Length of the ground along x and width along z, m; one cell a metre.
pub const LENGTH: u16 = 480;
pub const WIDTH: u16 = 60;

/// Distance from the middle at which the ground begins to fall to the plain, and at which it has fallen, m.
const SHOULDER: [f32; 2] = [16.0, 29.0];

/// The ground.
#[derive(Component, Clone, Copy, Debug)]
pub struct Ground;

/// Height of the ground at a place, m: waves of 56 m and 18 m across the way, and bumps of 7 m.
pub fn height(x: f32, z: f32) -> f32 {
    let waves = 0.6 + 0.3 * (x / 9.0).sin() + 0.04 * (x / 2.9 + z / 4.0).sin();
    let bumps = 0.015 * (0.9 * z).sin() * (0.9 * x).sin();
    let fallen = ((z.abs() - SHOULDER[0]) / (SHOULDER[1] - SHOULDER[0])).clamp(0.0, 1.0);
    (waves + bumps) * (1.0 - fallen * fallen * (3.0 - 2.0 * fallen)) - 0.05 * fallen
}

/// Places of the samples along x or z, m.
pub fn places(extent: u16) -> impl Iterator<Item = f32> + Clone {
    (0..=extent).map(move |index| f32::from(index) - 0.5 * f32::from(extent))
}

/// Spawns the ground.
pub fn spawn(commands: &mut Commands) {
    let heights = places(LENGTH).flat_map(|x| places(WIDTH).map(move |z| height(x, z))).collect();
    // Rows lie along z, columns along x.
    let heights = Array2::new(usize::from(WIDTH) + 1, usize::from(LENGTH) + 1, heights);
    let size = Vec3::new(f32::from(LENGTH), 1.0, f32::from(WIDTH));
    let shape = SharedShape::heightfield(heights, size);
    commands.spawn((Ground, RigidBody::Static, Collider::from(shape), Transform::default()));
}
