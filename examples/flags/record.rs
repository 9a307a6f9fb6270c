//! What is measured tick by tick.

use std::mem;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothCounts, ClothTimings};
use bunting_examples::durations::Durations;
use bunting_examples::strain::Strain;
use bunting_scenes::Scene;
use bunting_solver::LinkFamily;

/// Everything that is measured in a run.
#[derive(Debug)]
pub struct Record {
    /// Particles along an edge of a flag at each level, the finest first.
    pub particles: Vec<u32>,
    /// Durations of each set.
    pub sets: Vec<(ClothSystems, Durations)>,
    /// Durations of whole ticks.
    pub total: Durations,
    /// Flags at each level at the end of each second.
    pub counts: Vec<Vec<usize>>,
    /// Strain along the warp in all ticks.
    pub warp: Strain,
    /// Strain along the weft in all ticks.
    pub weft: Strain,
    /// Strain along either in the ticks of this second.
    second: Strain,
}

impl Record {
    /// Begins a record.
    pub fn new(scene: &Scene) -> Self {
        let levels = 0..=scene.levels.switch_distances.len();
        Self {
            particles: levels.map(|level| ((scene.levels.finest - 1) >> level) + 1).collect(),
            sets: ClothSystems::ORDER.map(|set| (set, Durations::default())).to_vec(),
            total: Durations::default(),
            counts: Vec::new(),
            warp: Strain::default(),
            weft: Strain::default(),
            second: Strain::default(),
        }
    }

    /// Takes down the tick that was.
    pub fn take_tick(&mut self, world: &mut World) {
        let timings = world.resource::<ClothTimings>();
        for (set, durations) in &mut self.sets {
            durations.push(timings.of(*set));
        }
        self.total.push(timings.total());
        for cloth in world.query::<&ClothState>().iter(world) {
            self.warp.add(cloth, LinkFamily::Warp);
            self.weft.add(cloth, LinkFamily::Weft);
            self.second.add(cloth, LinkFamily::Warp);
            self.second.add(cloth, LinkFamily::Weft);
        }
    }

    /// Takes down the end of a second, and tells of it in a line.
    pub fn take_second(&mut self, world: &World, ticks: usize) -> String {
        let mut counts = world.resource::<ClothCounts>().0.clone();
        counts.resize(self.particles.len(), 0);
        let levels: Vec<String> = self
            .particles
            .iter()
            .zip(&counts)
            .map(|(n, count)| format!("{n}² × {count}"))
            .collect();
        self.counts.push(counts);
        let strain = mem::take(&mut self.second);
        format!(
            "{:>3} s  {}  {:.3} ms a tick  strain {:.2} %, at most {:.1} %",
            self.counts.len(),
            levels.join("  "),
            self.total.last(ticks).quantile(0.5),
            100.0 * strain.mean(),
            100.0 * strain.greatest(),
        )
    }
}
