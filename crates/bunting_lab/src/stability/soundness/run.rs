//! How the cases run.

use bunting_solver::{ClothBatch, FabricMaterial, StepSettings};

use crate::product::{TICK, rms_speed};

/// Acceleration of gravity, m/s².
pub(super) const GRAVITY: f32 = 9.81;

/// Greatest speed of cloth at rest, m/s RMS. Motion is visible from 10 mm/s on.
pub(super) const AT_REST: f64 = 1e-3;

/// The standard scenes' fabric, without damping and air.
pub(super) fn standard() -> FabricMaterial {
    FabricMaterial {
        area_density: 0.2,
        warp_stiffness: 1e4,
        weft_stiffness: 1e4,
        shear_stiffness: 200.0,
        damping: 0.0,
        pressure_coefficient: 0.0,
        friction_coefficient: 0.0,
        ..FabricMaterial::FLAG_POLYESTER
    }
}

/// Steps a batch for `seconds` s.
pub(super) fn advance(batch: &mut ClothBatch, seconds: f32, settings: StepSettings) {
    (0..(seconds / TICK).round() as usize).for_each(|_| batch.step(TICK, settings));
}

/// The greatest RMS speed of the lanes, m/s.
pub(super) fn fastest(batch: &ClothBatch) -> f64 {
    batch.occupied().map(|lane| rms_speed(batch, lane)).fold(0.0, f64::max)
}
