//! The stand of a parasol.

use bevy::prelude::*;

/// Height of the top of the canopy, m.
pub const HEIGHT: f32 = 2.5;

/// A parasol in the frame of its foot.
#[derive(Component, Clone, Copy, Debug)]
pub struct Parasol;
