//! Numbers of cloths by level table and level, and their costs.

use crate::lod::batch_costs::BatchCosts;
use crate::lod::candidate::{Candidate, LevelTable};

/// Number of cloths of each level table at each level.
#[derive(Clone, Debug, Default)]
pub(super) struct LevelCounts {
    counts: Vec<u32>,
    /// Number of cloths in each pool of several fabrics.
    pools: Vec<u32>,
    /// Number of changes since all cloths were counted.
    shifts: u32,
    /// Additional cost if one cloth changes to each level from the next coarser one, µs, and the number of changes
    /// after which it was computed. Most cloths ask for the same few steps.
    steps: Vec<(u32, f32)>,
    /// Number of levels in the table that has most.
    stride: usize,
}

impl LevelCounts {
    /// Counts cloths at levels, one level for each cloth, and returns the sum of their costs in a tick, µs.
    pub fn count(
        &mut self,
        tables: &[LevelTable],
        cloths: &[Candidate],
        levels: impl Iterator<Item = u32>,
    ) -> f32 {
        self.stride = tables.iter().map(|table| table.errors.len()).max().unwrap_or(0);
        self.counts.clear();
        self.counts.resize(tables.len() * self.stride, 0);
        self.shifts = 0;
        self.steps.clear();
        self.steps.resize(self.counts.len(), (u32::MAX, 0.0));
        for (cloth, level) in cloths.iter().zip(levels) {
            *self.at(tables, cloth.table, level) += 1;
        }
        self.pools.clear();
        let counts = self.counts.chunks(self.stride.max(1));
        let levels =
            tables.iter().zip(counts).flat_map(|(table, counts)| table.costs.iter().zip(counts));
        let mut sum = 0.0;
        for (cost, &count) in levels.filter(|(_, count)| **count > 0) {
            sum += cost.of(count);
            if let Some(pool) = cost.pool {
                let index = pool.index as usize;
                self.pools.resize(self.pools.len().max(index + 1), 0);
                let before = self.pools[index];
                self.pools[index] += cost.pooled(count);
                sum += cost.of_pool(self.pools[index]) - cost.of_pool(before);
            }
        }
        sum
    }

    /// Additional cost if one cloth changes to a level from the next coarser one, µs.
    pub fn step(&mut self, tables: &[LevelTable], table: u32, to: u32) -> f32 {
        let index = table as usize * self.stride + to as usize;
        if self.steps[index].0 != self.shifts {
            self.steps[index] = (self.shifts, self.difference(tables, table, to + 1, to));
        }
        self.steps[index].1
    }

    /// Additional cost if one cloth changes from one level to another, µs.
    pub fn difference(&mut self, tables: &[LevelTable], table: u32, from: u32, to: u32) -> f32 {
        let costs = &tables[table as usize].costs;
        let (leaves, enters) = (&costs[from as usize], &costs[to as usize]);
        let [old, new] = [from, to].map(|level| *self.at(tables, table, level));
        let of_fabric = leaves.of(old - 1) - leaves.of(old) + enters.of(new + 1) - enters.of(new);
        let of_pools =
            self.pool_difference(leaves, old, old - 1) + self.pool_difference(enters, new, new + 1);
        of_fabric + of_pools
    }

    /// Additional cost of a pool when the number of cloths of one fabric changes, µs.
    fn pool_difference(&mut self, costs: &BatchCosts, before: u32, after: u32) -> f32 {
        let Some(pool) = self.pool_of(costs).copied() else { return 0.0 };
        let changed = pool + costs.pooled(after) - costs.pooled(before);
        if changed == pool { 0.0 } else { costs.of_pool(changed) - costs.of_pool(pool) }
    }

    /// Counts one cloth at another level.
    pub fn shift(&mut self, tables: &[LevelTable], table: u32, from: u32, to: u32) {
        self.shifts += 1;
        for (level, change) in [(from, -1), (to, 1)] {
            let costs = &tables[table as usize].costs[level as usize];
            let count = self.at(tables, table, level);
            let before = *count;
            let after = before.saturating_add_signed(change);
            *count = after;
            if let Some(pool) = self.pool_of(costs) {
                *pool = *pool + costs.pooled(after) - costs.pooled(before);
            }
        }
    }

    /// Number of cloths in the pool of a fabric, if it has one.
    fn pool_of(&mut self, costs: &BatchCosts) -> Option<&mut u32> {
        let index = costs.pool?.index as usize;
        self.pools.resize(self.pools.len().max(index + 1), 0);
        Some(&mut self.pools[index])
    }

    /// Number of cloths in the batches that a table's cloths at a level share.
    fn at(&mut self, tables: &[LevelTable], table: u32, level: u32) -> &mut u32 {
        let owner = tables[table as usize].owners[level as usize];
        &mut self.counts[owner as usize * self.stride + level as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Costs of batches of two levels of one fabric.
    fn table(owner: u32) -> LevelTable {
        let costs = [10.0, 1.0].map(|one| BatchCosts {
            one,
            eight: 3.0 * one,
            sixteen: Some(5.0 * one),
            most_single: 1,
            pool: None,
            per_cloth: 0.0,
            change: 0.0,
        });
        LevelTable::new(vec![0.01, 0.02], costs.to_vec(), vec![owner; 2], 1.0)
    }

    fn cloths(tables: [u32; 6]) -> Vec<Candidate> {
        let cloth = |table| Candidate {
            table,
            level: 1,
            pixels_per_metre: 1.0,
            importance: 1.0,
            ready: true,
            fresh: false,
            fixed: false,
            may_be_still: false,
            on_screen: true,
        };
        tables.map(cloth).to_vec()
    }

    #[test]
    fn tables_of_one_fabric_and_as_many_substeps_share_batches() {
        let cloths = cloths([0, 0, 0, 1, 1, 1]);
        let cost = |owner: u32| {
            let tables = [table(0), table(owner)];
            LevelCounts::default().count(&tables, &cloths, [1; 6].into_iter())
        };
        assert_eq!(cost(1), 6.0, "two batches of eight lanes");
        assert_eq!(cost(0), 3.0, "one");
    }

    #[test]
    fn a_step_costs_what_a_change_costs_after_every_shift() {
        let cloths = cloths([0, 1, 0, 1, 0, 1]);
        for owner in [0, 1] {
            let tables = [table(0), table(owner)];
            let mut counts = LevelCounts::default();
            counts.count(&tables, &cloths, [1; 6].into_iter());
            for shifted in [0, 1, 0, 1, 0] {
                for table in [0, 1, 0] {
                    let expected = counts.clone().difference(&tables, table, 1, 0);
                    assert_eq!(counts.step(&tables, table, 0), expected);
                }
                counts.shift(&tables, shifted, 1, 0);
            }
        }
    }
}
