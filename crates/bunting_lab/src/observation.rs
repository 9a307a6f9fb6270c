//! Observation of a run, the same for the reference and for every method.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{
    reference::grid::Grid,
    scenes::{Scene, TICK_RATE},
    stats::{self, Strain},
};

/// Ticks at which positions are stored for comparison: 0.2, 0.4 and 0.6 s.
pub const COMPARED_TICKS: [usize; 3] = [12, 24, 36];
/// Distance from the origin in metres beyond which a run counts as exploded.
const ARENA: f64 = 10.0;

/// Figures of one run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Observation {
    /// Positions at `COMPARED_TICKS`, m, up to the end of the run.
    pub compared: Vec<Vec<DVec3>>,
    /// Strain of warp and weft links: means and percentiles are averaged over the window's ticks, the maximum
    /// is taken over them.
    pub strain: Strain,
    /// Mean position of the last vertex (the free lower right corner) in the window, m.
    pub tip: DVec3,
    /// Standard deviation of the last vertex's position, m.
    pub tip_spread: f64,
    /// Flutter frequency of the tip out of the sheet's plane, Hz.
    pub flutter: Option<f64>,
    /// Root mean square velocity at the end, m/s.
    pub final_speed: f64,
    /// Whether every position stayed finite and within the arena.
    pub stable: bool,
}

impl Observation {
    /// Root mean square distance to another run at entry `k` of `COMPARED_TICKS`, m.
    #[must_use]
    pub fn rms_error(&self, other: &Self, k: usize) -> Option<f64> {
        Some(stats::rms_distance(self.compared.get(k)?, other.compared.get(k)?))
    }
}

/// Observes a run tick by tick.
#[derive(Debug)]
pub struct Observer<'a> {
    grid: &'a Grid,
    window_start: usize,
    tick: usize,
    strains: Vec<Strain>,
    tips: Vec<DVec3>,
    observation: Observation,
}

impl<'a> Observer<'a> {
    /// An observer of a run of the scene, whose grid is given.
    #[must_use]
    pub fn new(scene: &Scene, grid: &'a Grid) -> Self {
        let observation = Observation { stable: true, ..Observation::default() };
        let window_start = scene.window_start();
        Self { grid, window_start, tick: 0, strains: Vec::new(), tips: Vec::new(), observation }
    }

    /// Records the state after the next tick. Returns whether the run is worth continuing.
    pub fn observe(&mut self, positions: &[DVec3], velocities: &[DVec3]) -> bool {
        self.tick += 1;
        self.observation.stable &=
            positions.iter().all(|x| x.is_finite() && x.length_squared() < ARENA * ARENA);
        if !self.observation.stable {
            return false;
        }
        if COMPARED_TICKS.contains(&self.tick) {
            self.observation.compared.push(positions.to_vec());
        }
        if self.tick > self.window_start {
            self.strains.push(Strain::of(self.grid.strains(positions)));
            self.tips.push(positions[positions.len() - 1]);
        }
        self.observation.final_speed = stats::rms_length(velocities);
        true
    }

    /// The figures of the run.
    #[must_use]
    pub fn finish(self) -> Observation {
        let average = |figure: fn(&Strain) -> f64| {
            let figures: Vec<f64> = self.strains.iter().map(figure).collect();
            stats::mean(&figures)
        };
        let along = |axis: fn(&DVec3) -> f64| self.tips.iter().map(axis).collect::<Vec<f64>>();
        let (x, y, z) = (along(|t| t.x), along(|t| t.y), along(|t| t.z));
        let spreads = DVec3::new(stats::spread(&x), stats::spread(&y), stats::spread(&z));
        Observation {
            strain: Strain {
                mean: average(|s| s.mean),
                p95: average(|s| s.p95),
                p99: average(|s| s.p99),
                p999: average(|s| s.p999),
                max: self.strains.iter().map(|s| s.max).fold(0.0, f64::max),
            },
            tip: DVec3::new(stats::mean(&x), stats::mean(&y), stats::mean(&z)),
            tip_spread: spreads.length(),
            flutter: stats::crossing_frequency(&z, f64::from(TICK_RATE)),
            ..self.observation
        }
    }
}
