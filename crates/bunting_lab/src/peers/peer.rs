//! The interface through which an engine's cloth is measured.

use crate::simulation::Simulation;

/// A cloth that can be disturbed.
pub trait Peer: Simulation {
    /// Moves the cloth's supports sideways by `metres` m within the next tick, and runs this tick.
    fn teleport(&mut self, metres: f32);
    /// Advances by one tick of `seconds` s.
    fn hitch(&mut self, seconds: f32);
}
