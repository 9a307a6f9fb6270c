//! The rail.

use bevy::prelude::*;

/// Middle of the rail, m, which lies along x.
pub const RAIL: Vec3 = Vec3::new(-0.45, 0.95, 0.0);

/// Half the length and radius of the rail, m.
pub const RAIL_SIZE: [f32; 2] = [0.36, 0.018];
