//! What the choice of levels led to.

use core::time::Duration;

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::activity::ClothActivity;

/// What the [`ClothBudget`](crate::ClothBudget) led to in the last tick.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct LodReport {
    /// Expected time of the tick.
    pub expected: Duration,
    /// Time that the choice of levels took, without the changes of level that followed.
    pub choice: Duration,
    /// Number of cloths that changed their level.
    pub switches: usize,
    /// Number of cloths that are coarser than their error demands, for lack of time.
    pub held_back: usize,
    /// Number of cloths that sleep because they are outside of every viewer's picture.
    pub off_screen: usize,
    /// Number of cloths that sleep because they are out of every viewer's range.
    pub out_of_range: usize,
    /// Number of cloths that sleep because they have come to rest.
    pub at_rest: usize,
}

impl LodReport {
    /// Number of cloths that sleep.
    #[must_use]
    pub fn asleep(&self) -> usize {
        self.off_screen + self.out_of_range + self.at_rest
    }

    pub(crate) fn count(&mut self, activity: ClothActivity) {
        match activity {
            ClothActivity::Ticking => {}
            ClothActivity::OffScreen => self.off_screen += 1,
            ClothActivity::OutOfRange => self.out_of_range += 1,
            ClothActivity::AtRest => self.at_rest += 1,
        }
    }
}

/// Number of cloths at each level of detail in the last tick, the finest first. Simulated and paused
/// cloths count; sleeping ones are counted in the [`LodReport`].
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ClothCounts(pub Vec<usize>);

impl ClothCounts {
    /// Counts a cloth at a level.
    pub(crate) fn add(&mut self, level: usize) {
        if self.0.len() <= level {
            self.0.resize(level + 1, 0);
        }
        self.0[level] += 1;
    }
}
