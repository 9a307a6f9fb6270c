//! Häggström's figure B.1: the share of each phase in a tick, at each level.

use bunting_solver::{ClothBatch, LaneCount, StepSettings};
use serde::Serialize;

use super::{Effort, LEVELS, scheme_name, schemes};
use crate::{fleet::Fleet, product::TICK, scenes::Scene, timing::Timing};

/// The phases of a tick, in the order in which they run.
pub const PHASES: [&str; 5] = ["begin", "integrate", "constraints", "velocities", "normals"];

/// One phase of one level.
#[derive(Clone, Debug, Serialize)]
pub struct Phase {
    /// Vertices along each side.
    pub n: u32,
    /// Name, of [`PHASES`].
    pub phase: &'static str,
    /// Scheme.
    pub scheme: &'static str,
    /// Part of the tick's time: the phase's median over the sum of all medians.
    pub share: f64,
    /// Median time in a tick, µs, of a full batch.
    pub us: f64,
}

/// Shares of all phases at all levels, of a full batch of the widest lanes.
#[must_use]
pub fn measure(effort: &Effort) -> Vec<Phase> {
    schemes()
        .into_iter()
        .flat_map(|settings| LEVELS.map(|n| (settings, n)))
        .flat_map(|(settings, n)| split(n, settings, effort))
        .collect()
}

fn split(n: u32, settings: StepSettings, effort: &Effort) -> Vec<Phase> {
    let lanes = LaneCount::holding(usize::MAX).get();
    let mut fleet = Fleet::new(Scene::flag(n as usize), lanes, settings);
    fleet.advance(effort.warm_up);
    let whole = Timing::repeat(1, effort.least_ticks, || fleet.advance(1));
    let mut times: [Timing; PHASES.len()] = Default::default();
    for _ in 0..effort.ticks(whole.median()) {
        fleet.drive();
        tick(&mut fleet.batches_mut()[0], settings, &mut times);
    }
    let medians = times.map(|time| time.median());
    let total: f64 = medians.iter().sum();
    PHASES
        .into_iter()
        .zip(medians)
        .map(|(phase, us)| Phase { n, phase, scheme: scheme_name(settings), share: us / total, us })
        .collect()
}

/// [`ClothBatch::step`] with a clock round each phase; those of the substeps are added up.
fn tick(batch: &mut ClothBatch, settings: StepSettings, times: &mut [Timing; PHASES.len()]) {
    let [begin, integrate, constraints, velocities, normals] = times;
    begin.time(|| batch.begin_tick(TICK, settings));
    let mut substeps: [Timing; 3] = Default::default();
    for _ in 0..settings.substeps {
        substeps[0].time(|| batch.integrate());
        substeps[1].time(|| batch.solve_constraints());
        substeps[2].time(|| batch.update_velocities());
    }
    for (sum, parts) in [integrate, constraints, velocities].into_iter().zip(&substeps) {
        sum.push(parts.total());
    }
    normals.time(|| batch.compute_normals());
}
