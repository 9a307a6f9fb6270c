//! What an engine's cloth must offer to be measured.

use crate::simulation::Simulation;

/// A cloth that can be treated badly.
pub trait Peer: Simulation {
    /// Moves what holds the cloth sideways by some metres within the next tick, and ticks.
    fn teleport(&mut self, metres: f32);
    /// Advances by one tick of some seconds.
    fn hitch(&mut self, seconds: f32);
}
