//! The interface of a cloth under trial.

use bunting_solver::StepSettings;
use glam::DVec3;

use crate::{scenes::Scene, simulation::Simulation};

/// A cloth whose positions and load can be set.
pub trait Specimen: Simulation {
    /// Overwrites positions (m) and velocities (m/s), including those of pinned vertices.
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]);
    /// Sets the gravitational acceleration along −y, m/s².
    fn load(&mut self, gravity: f64);
}

/// Starts the method under trial on a scene.
pub type Mount = dyn Fn(&Scene, StepSettings) -> Box<dyn Specimen>;
