//! Whether a cloth is simulated, and what is remembered to tell.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::fabric::levels::ClothLevels;
use crate::lod::Candidate;

/// Whether a cloth is simulated or asleep. A sleeping cloth keeps its shape, goes with its frame, and
/// costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum ClothActivity {
    /// It is simulated.
    #[default]
    Ticking,
    /// It is in nobody's picture. It goes on, at its coarsest level, when it comes near one.
    OffScreen,
    /// It is out of every viewer's range.
    OutOfRange,
    /// It is hidden by its `Visibility` or that of what it is a child of; with the feature `render`. It goes on from
    /// where it was.
    Hidden,
    /// It hangs still. It goes on when anything changes that acts on it: its frame, its material, the
    /// wind, gravity, a collider near it, or when a finer level is wanted.
    AtRest,
}

/// What the choice of levels remembers of a cloth.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct ClothWatch {
    /// Where the levels are that it is of: for comparison only.
    levels: usize,
    /// What the governor was last told, where the cloth is simulated.
    pub candidate: Option<Candidate>,
    /// What the cloth did when it was last looked at.
    pub activity: ClothActivity,
    /// Where the particle in the middle then was, in the cloth's frame, m.
    pub middle: Vec3,
    /// No particle is farther from it than this, m.
    pub radius: f32,
    /// Chooses the ticks in which it is looked at.
    pub turn: u32,
    /// Tick of the last change of level.
    pub changed: u32,
    /// Tick in which it was last seen.
    pub seen: u32,
}

/// What the watch over what comes to rest remembers of a cloth.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct ClothRest {
    /// Ticks at rest.
    pub still: u32,
    /// The frame's pose at the end of the last tick.
    pub pose: Option<Isometry3d>,
}

impl ClothWatch {
    /// Of a cloth that is new.
    pub fn new(levels: &Arc<ClothLevels>, radius: f32, turn: u32, now: u32) -> Self {
        let levels = Arc::as_ptr(levels).addr();
        Self { levels, radius, turn, changed: now, seen: now, ..Self::default() }
    }

    /// Whether it is of a cloth with these levels.
    pub fn is_of(&self, levels: &Arc<ClothLevels>) -> bool {
        self.levels == Arc::as_ptr(levels).addr()
    }
}
