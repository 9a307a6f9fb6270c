//! What the choice of levels and the sleep of resting cloths keep of a cloth from tick to tick.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};

use crate::cloth::activity::ClothActivity;
use crate::fabric::levels::ClothLevels;
use crate::lod::candidate::Candidate;

/// What the choice of levels keeps of a cloth.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct LodRecord {
    /// Address of the levels that the record is about, for comparison only.
    levels: usize,
    /// The cloth as the governor last saw it; none of a cloth that is not simulated.
    pub candidate: Option<Candidate>,
    /// The activity when the cloth was last examined.
    pub activity: ClothActivity,
    /// Position of the middle particle at that time, in the cloth's frame, m.
    pub middle: Vec3,
    /// Greatest distance of any particle from the middle one, m.
    pub radius: f32,
    /// Number that decides in which ticks the cloth is examined.
    pub phase: u32,
    /// Tick of the last change of level.
    pub changed: u32,
    /// Last tick in which the cloth was on or near a screen.
    pub seen: u32,
}

impl LodRecord {
    /// The record of a cloth with levels that are new.
    pub fn new(levels: &Arc<ClothLevels>, radius: f32, phase: u32, now: u32) -> Self {
        let levels = Arc::as_ptr(levels).addr();
        Self { levels, radius, phase, changed: now, seen: now, ..Self::default() }
    }

    /// Whether the record is about a cloth with these levels.
    pub fn is_of(&self, levels: &Arc<ClothLevels>) -> bool {
        self.levels == Arc::as_ptr(levels).addr()
    }
}

/// What the sleep of resting cloths keeps of a cloth.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct RestTimer {
    /// Number of ticks for which the cloth has been at rest.
    pub ticks: u32,
    /// Pose of the frame at the end of the last tick.
    pub pose: Option<Isometry3d>,
}
