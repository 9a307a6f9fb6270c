//! Position Verlet at a step that resolves every spring.
//!
//! Explicit, symplectic and of second order (drift, kick, drift; Hairer, Lubich and Wanner, "Geometric
//! Numerical Integration", section I.1.4). It solves no system and projects no constraint, so it shares
//! nothing with the methods that it is compared with; its steps must be short compared with the period of the
//! stiffest spring. Drag uses the velocity in the middle of the kick.

use glam::{DVec3, dvec3};

use super::grid::Grid;
use crate::{
    scenes::{Scene, TICK_RATE},
    stats::worse,
};

/// Longest step as a fraction of the stability limit 2/ω.
pub const STEP_FRACTION: f64 = 0.25;
/// Least number of steps a tick, for soft cloths.
pub const FEWEST_STEPS: usize = 400;

/// A cloth in motion.
#[derive(Clone, Debug)]
pub struct Verlet {
    scene: Scene,
    grid: Grid,
    steps: usize,
    ticks: usize,
    /// Positions, m.
    pub positions: Vec<DVec3>,
    /// Velocities, m/s.
    pub velocities: Vec<DVec3>,
    steady: Vec<DVec3>,
    forces: Vec<DVec3>,
    midway: Vec<DVec3>,
}

impl Verlet {
    /// The scene at its start, to be advanced by `steps` steps a tick.
    #[must_use]
    pub fn new(scene: &Scene, steps: usize) -> Self {
        let positions = scene.positions();
        let still = vec![DVec3::ZERO; positions.len()];
        Self {
            grid: Grid::new(scene),
            scene: scene.clone(),
            steps,
            ticks: 0,
            positions,
            velocities: still.clone(),
            steady: still.clone(),
            forces: still.clone(),
            midway: still,
        }
    }

    /// The cloth's grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Advances by one tick.
    pub fn tick(&mut self) {
        let tick = f64::from(TICK_RATE).recip();
        let step = tick / self.steps as f64;
        for k in 0..self.steps {
            let middle = self.ticks as f64 * tick + (k as f64 + 0.5) * step;
            self.step(step, middle);
        }
        self.ticks += 1;
    }

    /// Largest sum of gravity and elastic forces on a free vertex, N.
    #[must_use]
    pub fn residual(&mut self) -> f64 {
        self.gather_steady_forces();
        let free = self.steady.iter().zip(&self.grid.inverse_masses).filter(|(_, w)| **w > 0.0);
        free.map(|(f, _)| f.length()).fold(0.0, worse)
    }

    /// One step of length `h` seconds about the instant `middle`.
    pub fn step(&mut self, h: f64, middle: f64) {
        let decay = (-0.5 * self.scene.damping * h).exp();
        for (x, v) in self.positions.iter_mut().zip(&mut self.velocities) {
            *x += *v * (0.5 * h);
            *v *= decay;
        }
        self.gather_steady_forces();
        if self.scene.air.is_vacuum() {
            kick(&mut self.velocities, &self.steady, &self.grid.inverse_masses, h);
        } else {
            self.midway.copy_from_slice(&self.velocities);
            self.gather_air_forces(middle);
            kick(&mut self.midway, &self.forces, &self.grid.inverse_masses, 0.5 * h);
            self.gather_air_forces(middle);
            kick(&mut self.velocities, &self.forces, &self.grid.inverse_masses, h);
        }
        for (x, v) in self.positions.iter_mut().zip(&mut self.velocities) {
            *v *= decay;
            *x += *v * (0.5 * h);
        }
    }

    fn gather_steady_forces(&mut self) {
        for (f, m) in self.steady.iter_mut().zip(&self.grid.masses) {
            *f = dvec3(0.0, -m * self.scene.gravity, 0.0);
        }
        self.grid.add_elastic_forces(&self.positions, &mut self.steady);
    }

    fn gather_air_forces(&mut self, time: f64) {
        self.forces.copy_from_slice(&self.steady);
        let wind = self.scene.air.wind_at(time);
        self.grid.add_air_forces(
            &self.scene.air,
            wind,
            &self.positions,
            &self.midway,
            &mut self.forces,
        );
    }
}

fn kick(velocities: &mut [DVec3], forces: &[DVec3], inverse_masses: &[f64], h: f64) {
    for ((v, f), w) in velocities.iter_mut().zip(forces).zip(inverse_masses) {
        *v += *f * (w * h);
    }
}

/// Steps a tick that keep `STEP_FRACTION` of the stability limit.
#[must_use]
pub fn resolving_steps(grid: &Grid) -> usize {
    let longest = STEP_FRACTION * 2.0 / grid.highest_frequency();
    FEWEST_STEPS.max((1.0 / (f64::from(TICK_RATE) * longest)).ceil() as usize)
}
