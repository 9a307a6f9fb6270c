//! The governor's view of a cloth: its level, its importance, and the errors and costs of its levels.

use crate::lod::batch_costs::BatchCosts;

/// Errors and costs of the levels of cloths that share their fabrics, the finest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct LevelTable {
    /// Error of each level, m.
    pub errors: Vec<f32>,
    /// Costs of each level.
    pub costs: Vec<BatchCosts>,
}

/// A simulated cloth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Index of its level table.
    pub table: u32,
    /// Its level.
    pub level: u32,
    /// Size of a metre at the cloth in the picture, px/m.
    pub pixels_per_metre: f32,
    /// Importance of one pixel of error of this cloth, compared with other cloths.
    pub importance: f32,
    /// Whether the last change of level is long enough ago for another.
    pub ready: bool,
    /// Whether the governor may not change the level: the cloth only adds to the costs.
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
    /// Error of a coarser level below which it is wanted, px.
    pub coarsen_below: f32,
    /// Greatest number of changes in a tick of cloths on a screen, and of those on none, whose changes
    /// cost little.
    pub switches: usize,
}

impl Candidate {
    /// Cost of one change to another level, µs; nothing for a cloth that is on no screen, whose change
    /// needs no care.
    pub fn cost_of_change(&self, tables: &[LevelTable], to: u32) -> f32 {
        let finer = &tables[self.table as usize].costs[self.level.min(to) as usize];
        if self.on_screen && self.level != to { finer.change } else { 0.0 }
    }

    /// The level that the errors of its levels (m) demand: the present one as long as its error is not
    /// too large, and that of the next coarser level not small enough.
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
