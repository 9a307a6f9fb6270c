//! The governor's view of a cloth: its level, its importance, and the errors and costs of its levels.

use crate::lod::batch_costs::BatchCosts;

/// Errors and costs of the levels of cloths that share their fabrics and their class of effort, the finest first. Behind the
/// coarsest level is one more, which costs nothing: the cloth is held still.
#[derive(Clone, Debug, Default)]
pub(crate) struct LevelTable {
    /// Error of each level, m.
    pub errors: Vec<f32>,
    /// Costs of each level.
    pub costs: Vec<BatchCosts>,
    /// Index of the table that counts the cloths at each level: tables of the same fabrics share the batches of a
    /// level at which their classes of effort take the same substeps.
    pub owners: Vec<u32>,
}

impl LevelTable {
    /// The table of levels with these errors, m, costs and owners. A cloth of a given size, m, that is held still is off
    /// by its size more than at its coarsest level.
    pub fn new(
        mut errors: Vec<f32>,
        mut costs: Vec<BatchCosts>,
        mut owners: Vec<u32>,
        size: f32,
    ) -> Self {
        errors.push(errors.last().copied().unwrap_or_default() + size);
        costs.push(BatchCosts::default());
        owners.push(owners.last().copied().unwrap_or_default());
        Self { errors, costs, owners }
    }

    /// The coarsest level at which cloths are simulated.
    pub fn coarsest(&self) -> u32 {
        (self.errors.len() as u32).saturating_sub(2)
    }

    /// The level of a cloth that is held still.
    pub fn still(&self) -> u32 {
        self.coarsest() + 1
    }
}

/// A cloth that is simulated, or held still since there is no time for it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Candidate {
    /// Index of the cloth's level table.
    pub table: u32,
    /// Present level of the cloth, see [`LevelTable::still`].
    pub level: u32,
    /// Pixels in the picture for each metre at the cloth, px/m.
    pub pixels_per_metre: f32,
    /// Importance of one pixel of error of this cloth, compared with other cloths.
    pub importance: f32,
    /// Whether the least time since the last change of level has passed.
    pub ready: bool,
    /// Whether the cloth has not been simulated yet: it then starts at the chosen level, which is no change.
    pub fresh: bool,
    /// Whether the level is fixed: the cloth then only adds to the costs.
    pub fixed: bool,
    /// Whether the cloth may be held still where there is no time for its coarsest level.
    pub may_be_still: bool,
    /// Whether the cloth is on a screen.
    pub on_screen: bool,
}

/// Limits of the choice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Greatest sum of costs in a tick, µs.
    pub budget: f32,
    /// Error above which a finer level is wanted, px.
    pub refine_above: f32,
    /// Error of a coarser level below which that level is wanted, px.
    pub coarsen_below: f32,
    /// Greatest number of changes in a tick of cloths on a screen, and also of cloths on no screen, whose
    /// changes cost little, unless the budget is exceeded.
    pub switches: usize,
}

impl Candidate {
    /// Cost of one change to another level, µs; zero for a cloth on no screen, whose change needs neither
    /// easing nor conserved momentum.
    pub fn cost_of_change(&self, tables: &[LevelTable], to: u32) -> f32 {
        let table = &tables[self.table as usize];
        // A cloth that is held still keeps its state.
        let [from, to] = [self.level, to].map(|level| level.min(table.coarsest()));
        let finer = &table.costs[from.min(to) as usize];
        if self.on_screen && !self.fresh && from != to { finer.change } else { 0.0 }
    }

    /// The level that the errors of all levels demand: the present one as long as its error is not too
    /// large, and the error of the next coarser one not small enough. None demands that a cloth is held still.
    pub fn wanted_level(&self, table: &LevelTable, limits: &Limits) -> u32 {
        let pixels = |level: u32| self.pixels_per_metre * table.errors[level as usize];
        let mut level = self.level.min(table.coarsest());
        while level > 0 && pixels(level) > limits.refine_above {
            level -= 1;
        }
        while level < table.coarsest() && pixels(level + 1) < limits.coarsen_below {
            level += 1;
        }
        level
    }
}
