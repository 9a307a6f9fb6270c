//! Soundness: a solver must not gain energy by itself, oscillate at rest, stay locked, or slow down.

mod falling;
mod free;
mod hang;
mod jerk;
mod momentum;
mod pulled;
mod rates;
mod strips;

use bunting_solver::{ClothBatch, FabricMaterial, StepSettings};

use super::case::HardCase;
use crate::product::{TICK, rms_speed};

/// Acceleration of gravity, m/s².
const GRAVITY: f32 = 9.81;

/// Greatest speed of cloth at rest, m/s RMS. Motion is visible from 10 mm/s on.
const AT_REST: f64 = 1e-3;

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let mut cases = free::cases(quick);
    cases.extend(falling::cases());
    cases.extend(momentum::cases(quick));
    cases.extend(pulled::cases());
    cases.extend(strips::cases(quick));
    cases.extend(jerk::cases(quick));
    cases.extend(rates::cases());
    cases.extend(hang::cases(quick));
    cases
}

/// The standard scenes' fabric, without damping and air.
fn standard() -> FabricMaterial {
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
fn advance(batch: &mut ClothBatch, seconds: f32, settings: StepSettings) {
    (0..(seconds / TICK).round() as usize).for_each(|_| batch.step(TICK, settings));
}

/// The greatest RMS speed of the lanes, m/s.
fn fastest(batch: &ClothBatch) -> f64 {
    batch.occupied().map(|lane| rms_speed(batch, lane)).fold(0.0, f64::max)
}
