//! Intersecting triangles of a cloth, tick by tick.

use super::super::{intersections::intersecting_pairs, rig::Trial, row::Row};

/// Pairs of intersecting triangles of a cloth since its first tick.
#[derive(Default)]
pub(super) struct Watch {
    ticks: u32,
    /// Ticks with a pair at their end.
    with_any: u32,
    /// Most pairs in a tick.
    pub most: usize,
    /// Pairs in the last tick.
    pub last: usize,
}

impl Watch {
    /// Counts the pairs at the end of a tick.
    pub fn note(&mut self, cloth: &Trial) {
        self.last = intersecting_pairs(cloth.batch.fabric().triangles(), &cloth.positions());
        self.most = self.most.max(self.last);
        self.ticks += 1;
        self.with_any += u32::from(self.last > 0);
    }

    /// Row of the part of ticks in which any triangles intersect.
    pub fn row_of_ticks(&self, name: &str, us: f64) -> Row {
        /// Greatest part of ticks.
        const PART: f64 = 1e-3;
        let part = f64::from(self.with_any) / f64::from(self.ticks);
        Row::new(
            format!("{name}: ticks"),
            "part of ticks with intersections, of one",
            part,
            PART,
            us,
        )
    }
}
