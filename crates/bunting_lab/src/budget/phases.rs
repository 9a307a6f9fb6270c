//! Time of each phase of a tick, at each level.

use bunting_solver::{LaneCount, StepSettings};
use serde::Serialize;

use crate::{
    effort::Effort,
    fleet::Fleet,
    product::TICK,
    scenes::Scene,
    settings::{LEVELS, scheme_name, schemes},
    timing::Timing,
};

/// The phases of a tick, in the order in which they run.
pub const PHASES: [&str; 6] =
    ["begin", "integrate", "bending", "constraints", "velocities", "normals"];

/// One phase of one level.
#[derive(Clone, Debug, Serialize)]
pub struct Phase {
    /// Vertices along each side.
    pub n: u32,
    /// Name, of [`PHASES`].
    pub phase: &'static str,
    /// Scheme.
    pub scheme: &'static str,
    /// The phase's median time over the sum of all medians.
    pub fraction: f64,
    /// Median time in a tick of a full batch, µs.
    pub us: f64,
}

/// Median time of each phase in a tick of a full batch, µs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTimes {
    /// Compliances and contact candidates, once a tick.
    pub begin: f64,
    /// External forces, damping and prediction of all substeps.
    pub integrate: f64,
    /// Bending of all substeps; with Gauss–Seidel it is counted among the constraints.
    pub bending: f64,
    /// All other constraints of all substeps.
    pub constraints: f64,
    /// Velocities of all substeps.
    pub velocities: f64,
    /// Normals, once a tick.
    pub normals: f64,
}

impl PhaseTimes {
    /// The phases in the order of [`PHASES`].
    #[must_use]
    pub fn to_array(self) -> [f64; PHASES.len()] {
        [self.begin, self.integrate, self.bending, self.constraints, self.velocities, self.normals]
    }

    /// Sum over all phases, µs.
    #[must_use]
    pub fn total(self) -> f64 {
        self.to_array().iter().sum()
    }
}

/// Cloths in a full batch of the widest lanes.
#[must_use]
pub fn full_batch() -> usize {
    LaneCount::holding(usize::MAX).get()
}

/// Measures all phases at all levels.
#[must_use]
pub fn measure(effort: &Effort) -> Vec<Phase> {
    schemes()
        .into_iter()
        .flat_map(|settings| LEVELS.map(|n| (settings, n)))
        .flat_map(|(settings, n)| of_level(n, settings, effort))
        .collect()
}

fn of_level(n: u32, settings: StepSettings, effort: &Effort) -> Vec<Phase> {
    let fleet = Fleet::new(Scene::flag(n as usize), full_batch(), settings);
    let [times] = time_in_turn(&mut [fleet], effort);
    let scheme = scheme_name(settings);
    let phase = |(phase, us)| Phase { n, phase, scheme, fraction: us / times.total(), us };
    PHASES.into_iter().zip(times.to_array()).map(phase).collect()
}

/// Phases of the first batch of each fleet. The fleets' ticks alternate, so that all see the same load of the
/// machine.
pub fn time_in_turn<const FLEETS: usize>(
    fleets: &mut [Fleet; FLEETS],
    effort: &Effort,
) -> [PhaseTimes; FLEETS] {
    fleets.iter_mut().for_each(|fleet| fleet.advance(effort.warm_up));
    let whole = Timing::repeat(1, effort.least_ticks, || fleets[0].advance(1));
    let mut times: [[Timing; PHASES.len()]; FLEETS] = std::array::from_fn(|_| Default::default());
    for _ in 0..effort.ticks(whole.median()) {
        for (fleet, times) in fleets.iter_mut().zip(&mut times) {
            tick(fleet, times);
        }
    }
    times.map(|times| {
        let [begin, integrate, bending, constraints, velocities, normals] =
            times.map(|it| it.median());
        PhaseTimes { begin, integrate, bending, constraints, velocities, normals }
    })
}

/// Runs a tick of the fleet's first batch and times each phase; the times of all substeps are added up.
fn tick(fleet: &mut Fleet, times: &mut [Timing; PHASES.len()]) {
    fleet.drive();
    let settings = fleet.settings();
    let batch = &mut fleet.batches_mut()[0];
    let [begin, integrate, bending, constraints, velocities, normals] = times;
    begin.time(|| batch.begin_tick(TICK, settings));
    let mut substeps: [Timing; 4] = Default::default();
    for _ in 0..settings.substeps {
        substeps[0].time(|| batch.integrate());
        substeps[1].time(|| batch.solve_all_bending());
        substeps[2].time(|| batch.solve_all_but_bending());
        substeps[3].time(|| batch.update_velocities());
    }
    for (sum, parts) in [integrate, bending, constraints, velocities].into_iter().zip(&substeps) {
        sum.push(parts.total());
    }
    normals.time(|| batch.compute_normals());
}
