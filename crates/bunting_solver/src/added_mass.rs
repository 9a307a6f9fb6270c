//! Added mass near pins that stand alone.
//!
//! The directions of a yarn's links are frozen while it is solved, so the transverse vibration of a
//! taut link, ω² = T/(m l), is explicit, and unstable beyond h² T/(m l) ≈ ⅓. A point support carries
//! a whole cloth on a few light particles. There the inertia is raised to what the substep can
//! follow, from static bounds alone; gravity acts on the true mass, so that rest states are exact.

use crate::constants::GRAVITY;
use crate::fabric::Fabric;

/// Inertia that a particle needs, in units of (β h)² T/l: 4.2 was found to calm a cloth hung by two
/// corners, with some to spare, up to 65 × 65 at three substeps.
const INERTIA_PER_TENSION: f32 = 4.2;

/// One over each particle's area or more, 1/m²; zero where it is pinned. `step` is the effective
/// length of a substep, s.
pub(crate) fn weights(fabric: &Fabric, step: f32) -> Vec<f32> {
    let mut weights = fabric.inverse_areas().to_vec();
    let pins = fabric.pins();
    if pins.is_empty() || !pins.iter().all(|pin| pin.alone) {
        return weights;
    }
    let rest = fabric.rest_positions();
    let spacing = fabric.links().iter().map(|link| link.rest_length).fold(f32::MAX, f32::min);
    let load = fabric.area() * GRAVITY / pins.len() as f32;
    for (weight, at) in weights.iter_mut().zip(rest).filter(|(weight, _)| **weight > 0.0) {
        let nearest = pins
            .iter()
            .map(|pin| at.distance(rest[pin.particle as usize]))
            .fold(f32::MAX, f32::min);
        // A point load spreads as it goes away from its pin.
        let tension = load / (nearest / spacing).max(1.0);
        let area = INERTIA_PER_TENSION * step * step * tension / spacing;
        *weight = weight.min(1.0 / area);
    }
    weights
}
