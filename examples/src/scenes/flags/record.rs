//! Measurements of each tick and each second.

use std::mem;

use crate::Record;
use crate::durations::Durations;
use crate::strain::Strain;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothCounts, ClothTimings};
use bunting_scenes::Scene;
use bunting_solver::LinkFamily;

use crate::scenes::flags::measurements::Measurements;
use crate::scenes::flags::table;

/// The record of a run.
#[derive(Debug)]
pub struct FlagsRecord {
    measured: Measurements,
    /// Strain along warp and weft in the ticks of the current second.
    second: Strain,
    ticks: usize,
    ticks_per_second: usize,
}

impl FlagsRecord {
    /// An empty record.
    pub fn new(scene: &Scene, ticks_per_second: usize) -> Self {
        let levels = 0..=scene.levels.switch_distances.len();
        Self {
            measured: Measurements {
                particles: levels.map(|level| ((scene.levels.finest - 1) >> level) + 1).collect(),
                sets: ClothSystems::ORDER.map(|set| (set, Durations::default())).to_vec(),
                total: Durations::default(),
                counts: Vec::new(),
                warp: Strain::default(),
                weft: Strain::default(),
            },
            second: Strain::default(),
            ticks: 0,
            ticks_per_second,
        }
    }

    /// Ends a second. Returns a line that summarises it.
    fn end_second(&mut self, world: &World) -> String {
        let mut counts = world.resource::<ClothCounts>().0.clone();
        counts.resize(self.measured.particles.len(), 0);
        let levels: Vec<String> = self
            .measured
            .particles
            .iter()
            .zip(&counts)
            .map(|(particles, count)| format!("{particles}² × {count}"))
            .collect();
        self.measured.counts.push(counts);
        let strain = mem::take(&mut self.second);
        format!(
            "{:>3} s  {}  {:.3} ms a tick  strain {:.2} %, at most {:.1} %",
            self.measured.counts.len(),
            levels.join("  "),
            self.measured.total.last(self.ticks_per_second).quantile(0.5),
            100.0 * strain.mean(),
            100.0 * strain.greatest(),
        )
    }
}

impl Record for FlagsRecord {
    fn add_tick(&mut self, world: &mut World) -> Option<String> {
        let timings = world.resource::<ClothTimings>();
        for (set, durations) in &mut self.measured.sets {
            durations.push(timings.of(*set));
        }
        self.measured.total.push(timings.total());
        for cloth in world.query::<&ClothState>().iter(world) {
            self.measured.warp.add(cloth, LinkFamily::Warp);
            self.measured.weft.add(cloth, LinkFamily::Weft);
            self.second.add(cloth, LinkFamily::Warp);
            self.second.add(cloth, LinkFamily::Weft);
        }
        self.ticks += 1;
        self.ticks.is_multiple_of(self.ticks_per_second).then(|| self.end_second(world))
    }

    fn print(&self) -> bool {
        table::print(&self.measured);
        true
    }
}
