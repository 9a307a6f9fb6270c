//! Cost of nets that meshes are resampled to, beside that of a grid: alone, and in eight lanes.

use std::{sync::Arc, time::Instant};

use bunting_solver::{
    ClothBatch, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount, StepLimits,
};

use super::surfaces::{CLOTH, DAMPING, WIND};
use crate::{flight::almost_at_rest, meshes::clothes::Garment, product::TICK, scenes::ticks};

/// Rounds over all cloths, of which the fastest ones count.
const ROUNDS: usize = 40;

/// Ticks in a round.
const TICKS: u32 = 5;

/// Prints the least time of each net and a grid, for a particle and substep.
pub fn print(filter: &str) {
    let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
    let grid = grid.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric");
    let mut fabrics = vec![("grid of 33 × 33", grid)];
    for garment in Garment::all() {
        if filter.split(',').any(|part| garment.name.contains(part)) {
            if let Ok(net) = garment.builder().resampled(None) {
                fabrics.push((garment.name, net.fabric));
            }
        }
    }
    let calm = FabricMaterial { damping: DAMPING, ..CLOTH };
    let hung = (calm, Drive::default());
    let blown = (CLOTH, Drive { wind: WIND, ..Drive::default() });
    let mut rows = Vec::new();
    for (name, fabric) in fabrics {
        let fabric = Arc::new(fabric);
        for (state, (material, drive)) in [("hung", hung), ("blown", blown)] {
            for lanes in [LaneCount::One, LaneCount::Eight] {
                let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
                let count = if lanes == LaneCount::One { 1 } else { 8 };
                for lane in 0..count {
                    batch.insert(&almost_at_rest(&fabric), material).expect("a good cloth");
                    batch.drive(lane, drive).expect("a good drive");
                }
                rows.push(Row::new(name, state, count, batch));
            }
            if let [.., one, other] = &rows[..] {
                let of = |row: &Row| row.batch.snapshot(0).positions;
                assert!(of(one) == of(other), "{name} {state}: bits differ between layouts");
            }
        }
    }
    for _ in 0..ROUNDS {
        rows.iter_mut().for_each(Row::measure);
    }
    for row in rows {
        println!(
            "{:22} {:5} {} cloths: {:4} particles, {} substeps, {:7.1} us a tick, {:6.2} ns",
            row.name,
            row.state,
            row.count,
            row.batch.fabric().particle_count(),
            row.substeps,
            1e6 * row.best,
            row.nanoseconds(),
        );
    }
}

struct Row {
    name: &'static str,
    state: &'static str,
    count: usize,
    batch: ClothBatch,
    substeps: u32,
    /// Least time of a tick, s.
    best: f64,
}

impl Row {
    fn new(name: &'static str, state: &'static str, count: usize, mut batch: ClothBatch) -> Self {
        let settings = Self::settings(batch.fabric());
        for _ in 0..ticks(2.0) {
            batch.step(TICK, settings);
        }
        Self { name, state, count, batch, substeps: settings.substeps, best: f64::INFINITY }
    }

    fn settings(fabric: &Fabric) -> bunting_solver::StepSettings {
        StepLimits::default().of_fabric(fabric, TICK, 9.81)
    }

    fn measure(&mut self) {
        let settings = Self::settings(self.batch.fabric());
        for _ in 0..TICKS {
            let begun = Instant::now();
            self.batch.step(TICK, settings);
            self.best = self.best.min(begun.elapsed().as_secs_f64());
        }
    }

    /// Time of a particle of one cloth in a substep, ns.
    fn nanoseconds(&self) -> f64 {
        let particles = self.batch.fabric().particle_count() * self.count;
        1e9 * self.best / particles as f64 / f64::from(self.substeps)
    }
}
