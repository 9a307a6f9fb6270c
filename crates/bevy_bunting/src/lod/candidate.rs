//! The governor's view of a cloth: its level, its importance, and the errors and costs of its levels.

use crate::lod::batch_costs::BatchCosts;

/// Errors and costs of the levels of cloths that share their fabrics and their class of effort, the finest first.
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

/// A simulated cloth.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Candidate {
    /// Index of the cloth's level table.
    pub table: u32,
    /// Present level of the cloth.
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
        let finer = &tables[self.table as usize].costs[self.level.min(to) as usize];
        if self.on_screen && !self.fresh && self.level != to { finer.change } else { 0.0 }
    }

    /// The level that the errors of all levels (m) demand: the present one as long as its error is not too
    /// large, and the error of the next coarser one not small enough.
    pub fn wanted_level(&self, errors: &[f32], limits: &Limits) -> u32 {
        let pixels = |level: u32| self.pixels_per_metre * errors[level as usize];
        let mut level = self.level;
        while level > 0 && pixels(level) > limits.refine_above {
            level -= 1;
        }
        while level + 1 < errors.len() as u32 && pixels(level + 1) < limits.coarsen_below {
            level += 1;
        }
        level
    }
}
