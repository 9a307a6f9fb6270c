//! Irregular meshes: the material's own strain, motion, and the same bits at every width.

mod bits;
mod hanging;
mod moving;
mod shapes;

use std::sync::Arc;

use bunting_solver::{ClothBatch, ClothSnapshot, Fabric, FabricMaterial, LaneCount, StepSettings};

const TICK: f32 = 1.0 / 60.0;
/// Magnitude of gravity, m/s².
const GRAVITY: f32 = 9.81;

/// A material that hardly stretches and is isotropic but for Poisson's ratio, damped.
const ISOTROPIC: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 5e3,
    damping: 4.0,
    ..FabricMaterial::FLAG_POLYESTER
};

/// A material that stretches as cloth does, damped.
const CLOTH: FabricMaterial =
    FabricMaterial { warp_stiffness: 1e3, weft_stiffness: 1e3, shear_stiffness: 50.0, ..ISOTROPIC };

/// A lone cloth after some ticks under gravity.
fn after(
    ticks: u32,
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    settings: StepSettings,
) -> ClothSnapshot {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let cloth = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
    for _ in 0..ticks {
        batch.step(TICK, settings);
    }
    batch.snapshot(cloth)
}
