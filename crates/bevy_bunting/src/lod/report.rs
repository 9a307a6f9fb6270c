//! Results of the choice of levels.

use core::time::Duration;

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::EffortClass;

use crate::cloth::activity::ClothActivity;

/// Results of the choice of levels within the [`ClothBudget`](crate::ClothBudget) in the last tick.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct LodReport {
    /// Time of the tick that the governor expected.
    pub expected: Duration,
    /// Time that the choice of levels took, without the changes of level themselves.
    pub choice: Duration,
    /// Number of cloths that changed their level.
    pub switches: usize,
    /// Number of cloths that are coarser than their error demands because the budget is spent.
    pub held_back: usize,
    /// Number of simulated cloths by class of effort, see [`ClothEffort`](crate::ClothEffort), the least first.
    pub efforts: [usize; EffortClass::COUNT],
    /// Number of cloths that sleep because they are outside of every viewer's picture.
    pub off_screen: usize,
    /// Number of cloths that sleep because they are out of every viewer's range.
    pub out_of_range: usize,
    /// Number of cloths that sleep because they are hidden.
    pub hidden: usize,
    /// Number of cloths that sleep because they have come to rest.
    pub at_rest: usize,
    /// Number of cloths that are held still because there is no time for them even at their coarsest levels, see
    /// [`ClothBudget::still_below`](crate::ClothBudget::still_below). They are held back, too.
    pub over_budget: usize,
    /// Number of cloths, simulated or asleep, that have fewer levels than their [`LodSet`](crate::LodSet)s ask for: grids
    /// that cannot be halved so often, meshes with hardly any triangle left to remove, and meshes that would lose all
    /// attached vertices. The log names each such mesh once.
    pub fewer_levels: usize,
}

impl LodReport {
    /// Number of cloths that sleep.
    #[must_use]
    pub fn asleep(&self) -> usize {
        self.off_screen + self.out_of_range + self.hidden + self.at_rest + self.over_budget
    }

    /// Number of cloths that take more substeps than their weight needs.
    #[must_use]
    pub fn raised(&self) -> usize {
        self.efforts.iter().skip(1).sum()
    }

    pub(crate) fn count(&mut self, activity: ClothActivity) {
        match activity {
            ClothActivity::Ticking => {}
            ClothActivity::OffScreen => self.off_screen += 1,
            ClothActivity::OutOfRange => self.out_of_range += 1,
            ClothActivity::Hidden => self.hidden += 1,
            ClothActivity::AtRest => self.at_rest += 1,
            ClothActivity::OverBudget => self.over_budget += 1,
            // Neither is asleep.
            ClothActivity::AwaitsAsset
            | ClothActivity::AwaitsFabric
            | ClothActivity::AwaitsPreroll
            | ClothActivity::Failed => {}
        }
    }
}

/// Number of cloths at each level of detail in the last tick, the finest first. Simulated and paused cloths
/// are counted here; sleeping ones in the [`LodReport`].
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
