//! What every method offers to be measured.

use glam::Vec3;

/// A cloth that runs one of the scenes at 60 ticks a second.
pub trait Simulation {
    /// Advances by one tick.
    fn tick(&mut self);
    /// Positions in the scene's vertex order, m.
    fn positions(&self) -> &[Vec3];
    /// Velocities in the scene's vertex order, m/s.
    fn velocities(&self) -> &[Vec3];
}
