//! The wheels, and where they are mounted.

use bevy::prelude::*;

/// Radius of a wheel, m.
pub const RADIUS: f32 = 0.42;

/// Half of the distances of the wheels across and along the vehicle, m.
const HALF_TRACK: f32 = 0.9;
const HALF_WHEELBASE: f32 = 1.5;

/// Height of the springs' upper ends in the vehicle, m.
const MOUNT: f32 = 0.1;

/// A wheel: its place in the vehicle, m, with the height at which the ground holds it.
#[derive(Component, Clone, Copy, Debug)]
pub struct Wheel(pub Vec3);

/// Places of the wheels' mounts in the vehicle, m.
pub fn mounts() -> [Vec3; 4] {
    let mount = |x: f32, z: f32| Vec3::new(x * HALF_TRACK, MOUNT, z * HALF_WHEELBASE);
    [mount(-1.0, -1.0), mount(1.0, -1.0), mount(-1.0, 1.0), mount(1.0, 1.0)]
}
