//! Numbers of cloths by level table and level, and their costs.

use crate::lod::candidate::{Candidate, LevelTable};

/// Number of cloths of each level table at each level.
#[derive(Clone, Debug, Default)]
pub(super) struct LevelCounts {
    counts: Vec<u32>,
    /// Number of levels in the table with the most levels.
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
        let counts = self.counts.chunks(self.stride.max(1));
        let levels =
            tables.iter().zip(counts).flat_map(|(table, counts)| table.costs.iter().zip(counts));
        levels.map(|(cost, &count)| cost.of(count)).sum()
    }

    /// Additional cost if one cloth changes from one level to another, µs.
    pub fn difference(&mut self, tables: &[LevelTable], table: u32, from: u32, to: u32) -> f32 {
        let costs = &tables[table as usize].costs;
        let (leaves, enters) = (&costs[from as usize], &costs[to as usize]);
        let (old, new) = (*self.at(table, from), *self.at(table, to));
        leaves.of(old - 1) - leaves.of(old) + enters.of(new + 1) - enters.of(new)
    }

    /// Moves one cloth from one level to another.
    pub fn shift(&mut self, table: u32, from: u32, to: u32) {
        *self.at(table, from) -= 1;
        *self.at(table, to) += 1;
    }

    fn at(&mut self, table: u32, level: u32) -> &mut u32 {
        &mut self.counts[table as usize * self.stride + level as usize]
    }
}
