//! Displacements that keep a displayed surface out of colliders.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

/// Displacements (m) that lift the triangles of a displayed surface out of colliders, with the indices of the
/// displaced particles.
#[derive(Component, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClothLift {
    /// The level whose particles are displaced.
    pub(super) level: usize,
    /// Displacements before the last tick.
    pub(super) previous: Vec<(u32, Vec3)>,
    /// Displacements after the last tick.
    pub(super) current: Vec<(u32, Vec3)>,
}

impl ClothLift {
    /// Displaces the particles of a level's surface, interpolated between two ticks.
    pub fn apply(&self, level: usize, fraction: f32, positions: &mut [Vec3]) {
        if level != self.level {
            return;
        }
        for (lifts, part) in [(&self.previous, 1.0 - fraction), (&self.current, fraction)] {
            for &(particle, lift) in lifts {
                if let Some(position) = positions.get_mut(particle as usize) {
                    *position += lift * part;
                }
            }
        }
    }
}
