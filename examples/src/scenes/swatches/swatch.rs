//! A cloth on the rail.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Width and height of a cloth, m.
pub const SIZE: Vec2 = Vec2::new(0.36, 0.5);

/// A cloth, and how it looks.
#[cfg_attr(
    not(feature = "render"),
    expect(dead_code, reason = "only the fabric counts where nothing is drawn")
)]
#[derive(Component, Clone, Copy, Debug)]
pub struct Swatch {
    pub fabric: FabricMaterial,
    /// Red, green, blue in sRGB.
    pub colour: [f32; 3],
    /// Threads in a metre: coarse ones, which a camera at a metre's distance can see.
    pub threads: f32,
    /// Height of the threads, in distances of two threads.
    pub relief: f32,
    /// Part of the light that passes through the gaps between threads.
    pub gaps: f32,
    /// Part of the light that passes through the threads.
    pub transmission: f32,
}
