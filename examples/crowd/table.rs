//! What was measured, and the table of it.

use std::mem;

use bevy::prelude::*;
use bevy_bunting::{ClothCounts, ClothTimings, LodReport};
use bunting_examples::durations::Durations;
use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};

use crate::plaza::{Crowd, LEVELS};

/// Rows of the table.
const ROWS: usize = 12;

/// What is counted in each tick: cloths at each level, asleep, held back, and changed.
type Counts = [usize; LEVELS + 3];

/// Everything that is measured in a flight.
#[derive(Debug)]
pub struct Record {
    /// Ticks a second.
    rate: usize,
    ticks: Durations,
    choices: Durations,
    /// Of this second.
    counts: Vec<Counts>,
    /// Of all whole seconds.
    seconds: Vec<(Durations, Vec<Counts>)>,
}

impl Record {
    /// Begins a record, at a number of ticks a second.
    pub fn new(rate: usize) -> Self {
        let [ticks, choices] = Default::default();
        Self { rate, ticks, choices, counts: Vec::new(), seconds: Vec::new() }
    }

    /// Notes a tick.
    pub fn take(&mut self, world: &World) {
        let (timings, report) = (world.resource::<ClothTimings>(), world.resource::<LodReport>());
        self.ticks.push(timings.total());
        self.choices.push(report.choice);
        let mut counts = Counts::default();
        for (count, level) in counts.iter_mut().zip(&world.resource::<ClothCounts>().0) {
            *count = *level;
        }
        counts[LEVELS..].copy_from_slice(&[report.asleep(), report.held_back, report.switches]);
        self.counts.push(counts);
        if self.counts.len() == self.rate {
            self.seconds.push((self.ticks.last(self.rate), mem::take(&mut self.counts)));
        }
    }

    /// Prints all.
    pub fn print(&self, crowd: &Crowd) {
        let levels = (0..LEVELS).map(|level| format!("level {level}"));
        let before = ["second", "tick, ms", "95 %, ms"].map(ToOwned::to_owned);
        let after = ["asleep", "held back", "changes"].map(ToOwned::to_owned);
        let mut table = Table::new();
        table
            .load_style(UTF8_BORDERS_ONLY)
            .set_header(before.into_iter().chain(levels).chain(after));
        let step = self.seconds.len().div_ceil(ROWS).max(1);
        for (second, (ticks, counts)) in self.seconds.iter().enumerate().step_by(step) {
            let sum = |index: usize| counts.iter().map(|counts| counts[index]).sum::<usize>();
            let mean = |index: usize| format!("{:.0}", sum(index) as f64 / counts.len() as f64);
            let cost = [0.5, 0.95].map(|part| format!("{:.3}", ticks.quantile(part)));
            let cells = [(second + 1).to_string()].into_iter().chain(cost);
            let changes = sum(LEVELS + 2).to_string();
            table.add_row(cells.chain((0..LEVELS + 2).map(mean)).chain([changes]));
        }
        for column in table.column_iter_mut() {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let budget = crowd.budget.as_secs_f64() * 1e3;
        println!("{table}\n");
        println!(
            "{} cloths, {:.0} % of the ticks within {budget} ms: median {:.3} ms, 95 % {:.3} ms",
            crowd.cloths,
            100.0 * self.ticks.part_within(budget),
            self.ticks.quantile(0.5),
            self.ticks.quantile(0.95),
        );
        println!("the choice of levels itself: median {:.3} ms", self.choices.quantile(0.5));
    }
}
