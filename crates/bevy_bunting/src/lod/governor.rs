//! Chooses the level of each cloth so that the total cost stays within the budget.
//!
//! The choice is a pure function of errors, importances and costs: it reads no world and no clock.
//!
//! 1. Every cloth starts at its coarsest level. Where these fill the budget, cloths that are small in the picture start one level behind it,
//!    at which they are held still. A step to the next finer level, up to the wanted one, reduces error and adds cost. Steps are sorted by
//!    reduced error over added cost, in buckets, which is linear in their number. Steps from held still to the coarsest level come
//!    first: a cloth is held still only where there is no time for all coarsest levels.
//! 2. In that order each step is taken if the sum of costs stays within the budget. Costs are those of
//!    whole batches: the ninth cloth of a batch of sixteen lanes is free, so a free lane is used by the
//!    next cloth in the order.
//! 3. Cloths change towards these levels, at most a fixed number in a tick, and each only some time after its
//!    last change; changes to coarser levels come first, and finer ones only while the budget has room. A change
//!    costs time, too: as long as any is due, the levels leave room for the dearest. Cloths that have not been
//!    simulated yet start at these levels.
//! 4. Where the budget is exceeded, as when a storm raises the substeps of all cloths at once, more cloths become coarser
//!    in a tick: as many as cost no more than the excess, which every tick of waiting would cost again.

use crate::lod::candidate::{Candidate, LevelTable, Limits};
use crate::lod::level_counts::LevelCounts;

/// Factor on the value of steps up to the present level of a cloth, so that two cloths of equal value do not
/// alternate. The value grows with the fifth power of the inverse distance: the factor corresponds to half
/// the distance. Smaller: levels oscillate as viewers move. Larger: the nearest cloths stay coarse.
const PRESENT_LEVEL_FACTOR: f32 = 8.0;

/// Fraction of the budget that steps beyond a cloth's present level may fill, so that fluctuating costs do
/// not alternately open and close a batch.
const FINER_FRACTION: f32 = 0.95;

/// Greatest fraction of the budget that is reserved for changes of level: dearer changes exceed the budget.
const MOST_RESERVED: f32 = 0.25;

/// Cost of giving a new cloth a lane, over that of a change of level. Each new cloth has this cost once, so that it
/// counts for every one of the cloths of a scene that is loaded.
const ENTERING: f32 = 0.5;

/// Number of low bits of a value that are dropped to make its bucket: the exponent and four bits are
/// left, a resolution of 1/16.
const BUCKET_SHIFT: u32 = 19;

/// Number of buckets for all positive floats. Steps from held still to the coarsest level have as many, before those of all other steps.
const BUCKETS: usize = 1 << (31 - BUCKET_SHIFT);

/// The chosen changes of level.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Choice {
    /// Indices of the cloths that change, and their new levels.
    pub switches: Vec<(usize, usize)>,
    /// Sum of costs in this tick, µs.
    pub cost: f32,
    /// Number of cloths that are coarser than their error demands because the budget is spent.
    pub held_back: usize,
}

/// A step of a cloth to its next finer level.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    /// Index of the cloth.
    cloth: u32,
    /// The finer level.
    to: u32,
    bucket: u32,
}

/// The governor. Its buffers are kept from tick to tick, so that nothing is allocated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Governor {
    steps: Vec<Step>,
    sorted: Vec<Step>,
    bucket_ends: Vec<u32>,
    /// Level that each cloth's error demands.
    wanted: Vec<u32>,
    /// Level that each cloth should have within the budget.
    chosen: Vec<u32>,
    counts: LevelCounts,
    /// Reduced error over added cost of the step to each level of each table, m/µs.
    step_values: Vec<f32>,
    /// Index in `step_values` of each table's finest level.
    first_values: Vec<usize>,
    /// Whether cloths may be held still in this tick.
    may_hold: bool,
    choice: Choice,
}

impl Governor {
    /// Chooses a level for every cloth, and the cloths that change in this tick.
    pub fn choose(
        &mut self,
        tables: &[LevelTable],
        cloths: &[Candidate],
        limits: &Limits,
    ) -> &Choice {
        self.value_steps(tables);
        let most = MOST_RESERVED * limits.budget;
        self.may_hold = self.lacks_time(tables, cloths, limits.budget - most);
        self.collect_steps(tables, cloths, limits);
        self.sort_steps();
        self.take_steps(tables, cloths, limits.budget);
        // The next tick may bring more new cloths, and changes of these. Levels that leave no room for them would be
        // given up again.
        let has_fresh = cloths.iter().any(|cloth| cloth.fresh);
        let reserve = if has_fresh { most } else { self.dearest_change(tables, cloths).min(most) };
        if reserve > 0.0 {
            self.take_steps(tables, cloths, limits.budget - reserve);
        }
        self.switch(tables, cloths, limits, reserve);
        &self.choice
    }

    /// Whether cloths are held still, or all coarsest levels exceed a budget (µs).
    fn lacks_time(&mut self, tables: &[LevelTable], cloths: &[Candidate], budget: f32) -> bool {
        let table = |cloth: &Candidate| &tables[cloth.table as usize];
        let coarsest =
            |cloth: &Candidate| if cloth.fixed { cloth.level } else { table(cloth).coarsest() };
        cloths.iter().any(|cloth| cloth.level == table(cloth).still())
            || self.counts.count(tables, cloths, cloths.iter().map(coarsest)) > budget
    }

    /// The last level that may be chosen for a cloth.
    fn last_level(&self, tables: &[LevelTable], cloth: &Candidate) -> u32 {
        let table = &tables[cloth.table as usize];
        if self.may_hold && cloth.may_be_still { table.still() } else { table.coarsest() }
    }

    /// Computes the value of the step to each level. A step is never worth more than the step before it, so
    /// that the order of steps is the order of levels.
    fn value_steps(&mut self, tables: &[LevelTable]) {
        self.step_values.clear();
        self.first_values.clear();
        for table in tables {
            let (first, mut least) = (self.step_values.len(), f32::MAX);
            self.first_values.push(first);
            self.step_values.resize(first + table.errors.len(), 0.0);
            for level in (0..table.errors.len().saturating_sub(1)).rev() {
                let gain = table.errors[level + 1] - table.errors[level];
                let [fine, coarse] =
                    [level, level + 1].map(|level| table.costs[level].of_one_among_many());
                let cost = fine - coarse;
                let value = if cost > 0.0 { gain.max(0.0) / cost } else { f32::MAX };
                least = least.min(value);
                self.step_values[first + level] = least;
            }
        }
    }

    /// Collects the steps of each cloth from its coarsest to its wanted level.
    fn collect_steps(&mut self, tables: &[LevelTable], cloths: &[Candidate], limits: &Limits) {
        self.steps.clear();
        self.wanted.clear();
        for (index, cloth) in cloths.iter().enumerate() {
            let table = &tables[cloth.table as usize];
            if cloth.fixed {
                self.wanted.push(cloth.level);
                continue;
            }
            let wanted = cloth.wanted_level(table, limits);
            self.wanted.push(wanted);
            let value_of_metre = cloth.pixels_per_metre * cloth.importance;
            for to in (wanted..self.last_level(tables, cloth)).rev() {
                let factor = if cloth.level <= to { PRESENT_LEVEL_FACTOR } else { 1.0 };
                let step = self.step_values[self.first_values[cloth.table as usize] + to as usize];
                let value = value_of_metre * step * factor;
                // No error is reduced, but a metre is worth more than any number: that is no number.
                let value = if value > 0.0 { value.min(f32::MAX) } else { 0.0 };
                let first = if to == table.coarsest() { 0 } else { BUCKETS as u32 };
                let bucket = first + BUCKETS as u32 - 1 - (value.to_bits() >> BUCKET_SHIFT);
                self.steps.push(Step { cloth: index as u32, to, bucket });
            }
        }
    }

    /// Sorts steps by buckets, the greatest value first; within a bucket in the order of the cloths.
    fn sort_steps(&mut self) {
        let buckets = self.steps.iter().map(|step| step.bucket);
        let first = buckets.clone().min().unwrap_or(0);
        let count = buckets.max().map_or(0, |last| last - first + 1);
        self.bucket_ends.clear();
        self.bucket_ends.resize(count as usize, 0);
        for step in &self.steps {
            self.bucket_ends[(step.bucket - first) as usize] += 1;
        }
        let mut end = 0;
        for bucket in &mut self.bucket_ends {
            end += core::mem::replace(bucket, end);
        }
        // Every element is overwritten.
        self.sorted.resize(self.steps.len(), Step::default());
        for step in &self.steps {
            let index = &mut self.bucket_ends[(step.bucket - first) as usize];
            self.sorted[*index as usize] = *step;
            *index += 1;
        }
    }

    /// Takes steps in their order, starting from every cloth's last level, within a budget (µs).
    fn take_steps(&mut self, tables: &[LevelTable], cloths: &[Candidate], budget: f32) {
        self.chosen.clear();
        for cloth in cloths {
            let last = self.last_level(tables, cloth);
            self.chosen.push(if cloth.fixed { cloth.level } else { last });
        }
        let mut cost = self.counts.count(tables, cloths, self.chosen.iter().copied());
        for step in &self.sorted {
            let index = step.cloth as usize;
            if self.chosen[index] != step.to + 1 {
                continue;
            }
            let cloth = &cloths[index];
            let fraction = if cloth.level <= step.to { 1.0 } else { FINER_FRACTION };
            let more = self.counts.step(tables, cloth.table, step.to);
            if more <= 0.0 || cost + more <= fraction * budget {
                cost += more;
                self.counts.shift(tables, cloth.table, step.to + 1, step.to);
                self.chosen[index] = step.to;
            }
        }
        let pairs = self.chosen.iter().zip(&self.wanted);
        self.choice.held_back = pairs.filter(|(chosen, wanted)| chosen > wanted).count();
    }

    /// The greatest cost of any change that is due, µs.
    fn dearest_change(&self, tables: &[LevelTable], cloths: &[Candidate]) -> f32 {
        let pairs = cloths.iter().zip(&self.chosen);
        pairs.map(|(cloth, &to)| cloth.cost_of_change(tables, to)).fold(0.0, f32::max)
    }

    /// Starts cloths that have not been simulated yet: at the chosen level while the budget has room for it,
    /// otherwise at the last, since other cloths become coarser only gradually. Returns the cost, µs.
    fn start_fresh(
        &mut self,
        tables: &[LevelTable],
        cloths: &[Candidate],
        budget: f32,
        mut cost: f32,
    ) -> f32 {
        let is_fresh = |cloth: &Candidate| cloth.fresh && !cloth.fixed;
        for cloth in cloths.iter().filter(|cloth| is_fresh(cloth)) {
            let to = self.last_level(tables, cloth);
            if cloth.level != to {
                cost += self.counts.difference(tables, cloth.table, cloth.level, to);
                self.counts.shift(tables, cloth.table, cloth.level, to);
            }
        }
        for (index, cloth) in cloths.iter().enumerate().filter(|(_, cloth)| is_fresh(cloth)) {
            let (from, mut to) = (self.last_level(tables, cloth), self.chosen[index]);
            if from != to {
                let more = self.counts.difference(tables, cloth.table, from, to);
                let entering = ENTERING * tables[cloth.table as usize].costs[to as usize].change;
                if cost + more + entering <= budget {
                    cost += more;
                    self.counts.shift(tables, cloth.table, from, to);
                } else {
                    to = from;
                }
            }
            if to != cloth.level {
                self.choice.switches.push((index, to as usize));
            }
        }
        cost
    }

    /// Chooses the changes of this tick: to coarser levels in the order of the cloths, then to finer levels
    /// in the order of the steps, as long as the costs stay within the budget less `reserve` for changes, µs.
    fn switch(
        &mut self,
        tables: &[LevelTable],
        cloths: &[Candidate],
        limits: &Limits,
        reserve: f32,
    ) {
        self.choice.switches.clear();
        // Numbers of changes that are left for cloths on no screen, and for cloths on one.
        let mut left = [limits.switches; 2];
        let mut changes = 0.0;
        let mut cost = self.counts.count(tables, cloths, cloths.iter().map(|cloth| cloth.level));
        let has_fresh = cloths.iter().any(|cloth| cloth.fresh);
        // On the way to the chosen levels costs may rise above those of these levels.
        let most = limits.budget - reserve;
        let budget = if has_fresh { most } else { limits.budget };
        cost = self.start_fresh(tables, cloths, budget, cost);
        // Waiting costs this much in each tick.
        let excess = (cost - budget).max(0.0);
        let switches = &mut self.choice.switches;
        for (index, (cloth, &to)) in cloths.iter().zip(&self.chosen).enumerate() {
            if cloth.fresh {
                continue;
            }
            let exceeds = cost > budget;
            let change = cloth.cost_of_change(tables, to);
            let left = &mut left[usize::from(cloth.on_screen)];
            let may = *left > 0 || (exceeds && changes + change <= excess);
            if to <= cloth.level || !may || !(cloth.ready || exceeds) {
                continue;
            }
            let more = self.counts.difference(tables, cloth.table, cloth.level, to);
            // A coarser level costs more where it needs another batch, and none becomes empty.
            if exceeds || more <= 0.0 || cost + more <= most {
                *left = left.saturating_sub(1);
                changes += change;
                cost += more;
                self.counts.shift(tables, cloth.table, cloth.level, to);
                switches.push((index, to as usize));
            }
        }
        for step in &self.sorted {
            let (cloth, chosen) = (&cloths[step.cloth as usize], self.chosen[step.cloth as usize]);
            // A cloth that has been held still is simulated at its coarsest level first.
            let to =
                if step.to == tables[cloth.table as usize].coarsest() { step.to } else { chosen };
            let left = &mut left[usize::from(cloth.on_screen)];
            // Each cloth is considered once, at the step from its present level, and may change by several
            // levels.
            let may = cloth.ready && !cloth.fresh;
            if step.to + 1 != cloth.level || chosen >= cloth.level || !may || *left == 0 {
                continue;
            }
            let more = self.counts.difference(tables, cloth.table, cloth.level, to);
            let change = cloth.cost_of_change(tables, to);
            let room = budget - (changes + change).min(MOST_RESERVED * limits.budget);
            if more <= 0.0 || cost + more <= room.min(most) {
                cost += more;
                changes += change;
                *left -= 1;
                self.counts.shift(tables, cloth.table, cloth.level, to);
                switches.push((step.cloth as usize, to as usize));
            }
        }
        self.choice.cost = cost + changes;
    }
}

#[cfg(test)]
#[path = "governor_tests.rs"]
mod tests;
