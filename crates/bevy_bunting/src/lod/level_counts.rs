//! Numbers of cloths by level table and level, and their costs.

use crate::lod::batch_costs::BatchCosts;
use crate::lod::candidate::{Candidate, LevelTable};

/// Number of cloths of each level table at each level.
#[derive(Clone, Debug, Default)]
pub(super) struct LevelCounts {
    counts: Vec<u32>,
    /// Number of cloths in each pool of several fabrics.
    pools: Vec<u32>,
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
        for (cloth, level) in cloths.iter().zip(levels) {
            *self.at(cloth.table, level) += 1;
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

    /// Additional cost if one cloth changes from one level to another, µs.
    pub fn difference(&mut self, tables: &[LevelTable], table: u32, from: u32, to: u32) -> f32 {
        let costs = &tables[table as usize].costs;
        let (leaves, enters) = (&costs[from as usize], &costs[to as usize]);
        let (old, new) = (*self.at(table, from), *self.at(table, to));
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
        for (level, change) in [(from, -1), (to, 1)] {
            let costs = &tables[table as usize].costs[level as usize];
            let before = *self.at(table, level);
            let after = before.saturating_add_signed(change);
            *self.at(table, level) = after;
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

    fn at(&mut self, table: u32, level: u32) -> &mut u32 {
        &mut self.counts[table as usize * self.stride + level as usize]
    }
}
