//! The time that all cloths together may take.

use core::time::Duration;

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::lod::cost_table::CostTable;

/// Time that all cloths together may take in a tick, and thresholds of the automatic choice of levels, see
/// [`LodSet::automatic`](crate::LodSet::automatic). The budget may be changed at any time.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use std::time::Duration;
///
/// // One millisecond a tick for all cloths with `LodSet::automatic`; insert it as a resource.
/// let budget = ClothBudget { tick: Duration::from_millis(1), ..ClothBudget::default() };
/// # assert!(budget.refine_above > budget.coarsen_below);
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothBudget {
    /// Time that a tick of all cloths may take on one core: it is named for what it limits, the work of one
    /// [`ClothTick`](crate::ClothTick), not its length in the game.
    pub tick: Duration,
    /// Source of the costs by which levels are chosen.
    pub costs: LodCosts,
    /// Error of a cloth from which a finer level is wanted, px.
    pub refine_above: f32,
    /// Error of a coarser level below which a cloth changes to it even if there is time for finer ones, px.
    pub coarsen_below: f32,
    /// Least number of ticks between two changes of a cloth's level, unless the budget is exceeded.
    pub dwell: u32,
    /// Greatest number of cloths on a screen that change their level in a tick, unless the budget is exceeded. The same
    /// number of cloths off the screen may change in addition.
    pub switches: usize,
    /// Radius in the picture, px, below which a cloth may be held still: where there is no time even for all cloths at their
    /// coarsest levels, the smallest in the picture keep their shape and move rigidly with their frames
    /// ([`ClothActivity::OverBudget`](crate::ClothActivity::OverBudget)). Zero: none is, and the budget is exceeded.
    pub still_below: f32,
    /// Angle beside the screen within which cloth is simulated, so that it has settled when it comes into
    /// view, rad.
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
            still_below: 200.0,
            margin: 0.05,
        }
    }
}

/// Source of the costs by which levels are chosen.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_bunting::{CostTable, LodCosts};
///
/// // The same levels on every machine and in every run.
/// let costs = LodCosts::Fixed(CostTable::default());
/// let budget = ClothBudget { costs, ..ClothBudget::default() };
/// # assert_ne!(budget, ClothBudget::default());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum LodCosts {
    /// Costs are measured while the app runs, so that the budget holds on this machine. The chosen levels
    /// then depend on the machine and on its other load.
    #[default]
    Measured,
    /// Costs are those of a table. The chosen levels, and so the bits of the simulation, are the same on
    /// every machine.
    Fixed(CostTable),
}
