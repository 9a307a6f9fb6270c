//! A figure that walks.

use bevy::prelude::*;

/// Speed of the walk, m/s.
pub const WALK: f32 = 1.4;

/// Speed of the run, m/s.
pub const RUN: f32 = 4.2;

/// A figure on its way.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Walker {
    /// Phase of the gait, rad: one turn for two steps.
    pub phase: f32,
    /// m/s.
    pub speed: f32,
    /// How far it sits, from 0 to 1.
    pub sit: f32,
    /// Angle by which the arms are held farther from the body than those of a figure in few clothes, rad.
    pub spread: f32,
    /// Angle by which the thighs are lifted higher in a run than those of a jogger, rad.
    pub lift: f32,
}

impl Walker {
    /// How much of a walk the gait is, from 0 to 1.
    pub fn walk(&self) -> f32 {
        (self.speed / WALK).clamp(0.0, 1.0)
    }

    /// How much of a run the walk is, from 0 to 1.
    pub fn run(&self) -> f32 {
        ((self.speed - WALK) / (RUN - WALK)).clamp(0.0, 1.0)
    }
}
