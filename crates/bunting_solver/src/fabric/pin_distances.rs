//! Distances along the cloth at rest from its pins, which are kept with the fabric.

use std::sync::OnceLock;

/// Distances along the cloth at rest from a pin.
#[derive(Clone, Debug)]
pub(crate) struct DistancesFromPin {
    /// Distance of each particle, m; infinite if no path leads to it.
    pub of_particles: Vec<f32>,
    /// All particles, the nearest one first.
    pub by_distance: Vec<u32>,
}

impl DistancesFromPin {
    pub(super) fn new(of_particles: Vec<f32>) -> Self {
        let distance = |particle: &u32| of_particles[*particle as usize];
        let mut by_distance: Vec<u32> = (0..of_particles.len() as u32).collect();
        by_distance.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
        Self { of_particles, by_distance }
    }
}

/// The distances from each pin that are known; empty before any is asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct PinDistances(pub OnceLock<Box<[OnceLock<DistancesFromPin>]>>);
