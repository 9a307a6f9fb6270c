//! Measurements of a flight, and their table.

use std::mem;
use std::time::Duration;

use crate::Record;
use crate::durations::Durations;
use crate::table::table;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothCounts, ClothTimings, LodReport};

use crate::scenes::crowd::plaza::LEVELS;

/// Greatest number of rows of the table.
const ROWS: usize = 12;

/// Counts of one tick: cloths at each level, asleep, held back by the budget, and changing level.
type Counts = [usize; LEVELS + 3];

/// Measurements of a flight.
#[derive(Debug)]
pub struct CrowdRecord {
    ticks_per_second: usize,
    budget: Duration,
    ticks: Durations,
    /// Durations of the choice of levels.
    choices: Durations,
    /// Counts of the current second.
    counts: Vec<Counts>,
    /// Durations and counts of each whole second.
    seconds: Vec<(Durations, Vec<Counts>)>,
    cloths: usize,
}

impl CrowdRecord {
    /// An empty record.
    pub fn new(ticks_per_second: usize, budget: Duration) -> Self {
        Self {
            ticks_per_second,
            budget,
            ticks: Durations::default(),
            choices: Durations::default(),
            counts: Vec::new(),
            seconds: Vec::new(),
            cloths: 0,
        }
    }

    fn row(&self, second: usize) -> Vec<String> {
        let (ticks, counts) = &self.seconds[second];
        let sum = |column: usize| counts.iter().map(|counts| counts[column]).sum::<usize>();
        let mean = |column: usize| format!("{:.0}", sum(column) as f64 / counts.len() as f64);
        let cost = [0.5, 0.95].map(|fraction| format!("{:.3}", ticks.quantile(fraction)));
        let means = (0..LEVELS + 2).map(mean);
        let changes = sum(LEVELS + 2).to_string();
        [(second + 1).to_string()].into_iter().chain(cost).chain(means).chain([changes]).collect()
    }
}

impl Record for CrowdRecord {
    fn add_tick(&mut self, world: &mut World) -> Option<String> {
        let (timings, report) = (world.resource::<ClothTimings>(), world.resource::<LodReport>());
        self.ticks.push(timings.total());
        self.choices.push(report.choice);
        let mut counts = Counts::default();
        for (count, level) in counts.iter_mut().zip(&world.resource::<ClothCounts>().0) {
            *count = *level;
        }
        counts[LEVELS..].copy_from_slice(&[report.asleep(), report.held_back, report.switches]);
        self.counts.push(counts);
        if self.counts.len() == self.ticks_per_second {
            let ticks = self.ticks.last(self.ticks_per_second);
            self.seconds.push((ticks, mem::take(&mut self.counts)));
        }
        self.cloths = world.query::<&ClothMesh>().iter(world).count();
        None
    }

    fn print(&self) -> bool {
        let levels = (0..LEVELS).map(|level| format!("level {level}"));
        let before = ["second", "tick, ms", "95 %, ms"].map(ToOwned::to_owned);
        let after = ["asleep", "held back", "changes"].map(ToOwned::to_owned);
        let step = self.seconds.len().div_ceil(ROWS).max(1);
        let rows = (0..self.seconds.len()).step_by(step).map(|second| self.row(second));
        println!("{}\n", table(before.into_iter().chain(levels).chain(after), rows));
        let budget = self.budget.as_secs_f64() * 1e3;
        println!(
            "{} cloths, {:.0} % of the ticks within {budget} ms: {}",
            self.cloths,
            100.0 * self.ticks.fraction_within(budget),
            self.ticks.summary(),
        );
        println!("the choice of levels itself: median {:.3} ms", self.choices.quantile(0.5));
        true
    }
}
