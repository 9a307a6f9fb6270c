//! What is measured of a run.

use bevy_bunting::ClothSystems;

use crate::durations::Durations;
use crate::strain::Strain;

/// Measurements of a run.
#[derive(Debug)]
pub struct Measurements {
    /// Particles along an edge of a flag at each level, the finest first.
    pub particles: Vec<u32>,
    /// Durations of each set.
    pub sets: Vec<(ClothSystems, Durations)>,
    /// Durations of whole ticks.
    pub total: Durations,
    /// Number of flags at each level at the end of each second.
    pub counts: Vec<Vec<usize>>,
    /// Strain along the warp in all ticks.
    pub warp: Strain,
    /// Strain along the weft in all ticks.
    pub weft: Strain,
}
