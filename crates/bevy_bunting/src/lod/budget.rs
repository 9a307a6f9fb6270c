//! How much time cloth may take, and what was made of it.

use core::time::Duration;

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use super::costs::CostTable;
use crate::cloth::activity::ClothActivity;

/// What all cloths together may cost, for those whose levels are chosen automatically; see
/// [`LodSet::automatic`](crate::LodSet::automatic). It may be changed at any time.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothBudget {
    /// Time that a tick may take on one core.
    pub tick: Duration,
    /// How it is known what cloths cost.
    pub costs: LodCosts,
    /// Error of a cloth from which a finer level is wanted, px.
    pub refine_above: f32,
    /// Error that a coarser level may have to be enough, px.
    pub coarsen_below: f32,
    /// Ticks between two changes of one cloth's level, unless there is no time to wait for them.
    pub dwell: u32,
    /// Most changes of level in a tick, and as many again of what is in nobody's picture.
    pub switches: usize,
    /// How far beside the screen cloth is awake, so that it has settled when it comes into view, rad.
    pub margin: f32,
}

impl Default for ClothBudget {
    fn default() -> Self {
        Self {
            tick: Duration::from_millis(1),
            costs: LodCosts::Measured,
            refine_above: 1.0,
            coarsen_below: 0.5,
            dwell: 30,
            switches: 1,
            margin: 0.05,
        }
    }
}

/// How it is known what cloths cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum LodCosts {
    /// They are measured as they go. A budget is a promise about this machine, and no table knows
    /// it. Which levels are chosen then depends on the machine and on what else it does.
    #[default]
    Measured,
    /// They are what a table says, on every machine. The same world then gives the same bits.
    Fixed(CostTable),
}

/// What was made of the [`ClothBudget`] in the last tick.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct LodReport {
    /// What the tick was expected to cost.
    pub expected: Duration,
    /// Time that the choice itself took, without the changes that it led to.
    pub choice: Duration,
    /// Cloths that changed their level.
    pub switches: usize,
    /// Cloths that are coarser than they should be, for want of time.
    pub held_back: usize,
    /// Cloths asleep because no viewer has them in its picture.
    pub off_screen: usize,
    /// Cloths asleep because they are out of every viewer's range.
    pub out_of_range: usize,
    /// Cloths asleep because they are hidden.
    pub hidden: usize,
    /// Cloths asleep because they have come to rest.
    pub at_rest: usize,
}

impl LodReport {
    /// Number of cloths that are asleep.
    #[must_use]
    pub fn asleep(&self) -> usize {
        self.off_screen + self.out_of_range + self.hidden + self.at_rest
    }

    pub(crate) fn count(&mut self, activity: ClothActivity) {
        match activity {
            ClothActivity::Ticking => {}
            ClothActivity::OffScreen => self.off_screen += 1,
            ClothActivity::OutOfRange => self.out_of_range += 1,
            ClothActivity::Hidden => self.hidden += 1,
            ClothActivity::AtRest => self.at_rest += 1,
        }
    }
}
