//! How far a cloth sinks under its weight, beside the same cloth at a high effort.

use std::sync::Arc;

use bunting_solver::{ClothBatch, ClothSnapshot, Fabric, FabricMaterial, LaneCount, StepSettings};
use serde::Serialize;

use crate::product::TICK;

/// Time until it is measured, s.
const HANGING: f32 = 15.0;
/// Times the substeps and the passes of the high effort.
const HIGH: [u32; 2] = [8, 4];

/// How far the particles sink from where they are at rest, in the mean, m.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sag {
    /// With these settings.
    pub own: f64,
    /// At the high effort.
    pub converged: f64,
}

impl Sag {
    /// Of a cloth that hangs without wind.
    pub fn of(fabric: &Arc<Fabric>, material: FabricMaterial, settings: StepSettings) -> Self {
        let [substeps, passes] = HIGH;
        let high = StepSettings {
            substeps: substeps * settings.substeps,
            passes: passes * settings.passes,
            ..settings
        };
        let [own, converged] = [settings, high].map(|it| sag(fabric, material, it));
        Self { own, converged }
    }

    /// Distance between both, m.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.own - self.converged).abs()
    }
}

fn sag(fabric: &Arc<Fabric>, material: FabricMaterial, settings: StepSettings) -> f64 {
    let rest = ClothSnapshot::at_rest(fabric);
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    batch.insert(&rest, material).expect("a good cloth");
    for _ in 0..(HANGING / TICK).round() as usize {
        batch.step(TICK, settings);
    }
    let mut hung = rest.positions.clone();
    batch.copy_positions(0, &mut hung);
    let sunk = rest.positions.iter().zip(&hung).map(|(rest, hung)| f64::from(rest.y - hung.y));
    sunk.sum::<f64>() / hung.len() as f64
}
