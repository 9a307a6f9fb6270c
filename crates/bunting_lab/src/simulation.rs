//! The interface through which every method is measured.

use glam::{DVec3, Vec3};

use crate::scenes::ticks;

/// A cloth that runs one of the scenes at 60 ticks a second.
pub trait Simulation {
    /// Advances by one tick.
    fn tick(&mut self);
    /// Positions in the scene's vertex order, m.
    fn positions(&self) -> &[Vec3];
    /// Velocities in the scene's vertex order, m/s.
    fn velocities(&self) -> &[Vec3];
}

/// Advances by `seconds`.
pub fn run(simulation: &mut (impl Simulation + ?Sized), seconds: f64) {
    (0..ticks(seconds)).for_each(|_| simulation.tick());
}

/// Vectors in double precision, as closed forms and the reference use them.
#[must_use]
pub fn in_double(vectors: &[Vec3]) -> Vec<DVec3> {
    vectors.iter().map(|vector| vector.as_dvec3()).collect()
}
