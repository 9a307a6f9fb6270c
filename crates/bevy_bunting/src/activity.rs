//! Whether a cloth is simulated, and what is remembered to tell.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Isometry3d;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::levels::ClothLevels;

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
    /// It hangs still. It goes on when anything changes that acts on it: its frame, its material, the
    /// wind, gravity, a collider near it, or when a finer level is wanted.
    AtRest,
}

/// What is remembered of a cloth from tick to tick.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct ClothWatch {
    /// Where the levels are that `kind` and `radius` are of: for comparison only.
    levels: usize,
    pub kind: u32,
    /// No particle is farther from the one in the middle than this, m.
    pub radius: f32,
    /// Ticks since the last change of level.
    pub since_change: u32,
    /// Ticks in nobody's picture.
    pub unseen: u32,
    /// Ticks at rest.
    pub still: u32,
    /// The frame's pose at the end of the last tick.
    pub pose: Option<Isometry3d>,
}

impl ClothWatch {
    /// Of a cloth that is new. It need not wait for its first change.
    pub fn new(levels: &Arc<ClothLevels>, kind: usize, radius: f32) -> Self {
        let levels = Arc::as_ptr(levels).addr();
        let (kind, since_change) = (kind as u32, u32::MAX);
        Self { levels, kind, radius, since_change, ..Self::default() }
    }

    /// Whether it is of a cloth with these levels.
    pub fn is_of(&self, levels: &Arc<ClothLevels>) -> bool {
        self.levels == Arc::as_ptr(levels).addr()
    }
}
