//! A cloth as the trials handle it.

use bunting_solver::StepSettings;
use glam::DVec3;

use crate::{scenes::Scene, simulation::Simulation};

/// A cloth that can be laid out and loaded.
pub trait Specimen: Simulation {
    /// Overwrites positions in metres and velocities in metres a second, of pinned vertices too.
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]);
    /// Sets the gravitational acceleration along −y, m/s².
    fn load(&mut self, gravity: f64);
}

/// Starts the method under trial on a scene.
pub type Mount = dyn Fn(&Scene, StepSettings) -> Box<dyn Specimen>;
