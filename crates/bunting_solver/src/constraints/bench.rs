//! A single cloth whose constraints are solved one kind at a time, for the tests of each.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Fabric, FabricMaterial};
use crate::simd::lane::Pack1;
use crate::simd::vec3::{lane3, set_lane3};
use crate::step::StepSettings;

/// Length of the substep, s.
pub(super) const STEP: f32 = 1.0 / 120.0;

/// A batch of one cloth at the given positions, in a substep of backward Euler.
pub(super) fn cloth_at(
    fabric: &Fabric,
    material: FabricMaterial,
    positions: &[Vec3],
) -> LaneBatch<Pack1> {
    let mut batch = LaneBatch::new(Arc::new(fabric.clone()));
    batch.exchange(&[], &[(0, &ClothSnapshot::at_rest(fabric), material)]);
    batch.begin_tick(STEP, StepSettings::gauss_seidel(1));
    batch.begin_substep();
    for (pack, &position) in batch.position.iter_mut().zip(positions) {
        set_lane3(pack, 0, position);
    }
    batch
}

/// Where the particles are.
pub(super) fn positions(batch: &LaneBatch<Pack1>) -> Vec<Vec3> {
    batch.position.iter().map(|pack| lane3(pack, 0)).collect()
}

/// What an implicit step of an energy much softer than inertia moves each particle by, by central
/// differences: −w h²/σ ∂E/∂x.
pub(super) fn soft_step(
    fabric: &Fabric,
    material: &FabricMaterial,
    positions: &[Vec3],
    energy: impl Fn(&[Vec3]) -> f64,
) -> Vec<Vec3> {
    const DIFFERENCE: f32 = 1e-3;
    let scale = STEP * STEP / material.area_density;
    let slope = |particle: usize, axis: Vec3| {
        let at = |offset: f32| {
            let mut moved = positions.to_vec();
            moved[particle] += axis * offset;
            energy(&moved)
        };
        ((at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * f64::from(DIFFERENCE))) as f32
    };
    (0..positions.len())
        .map(|particle| {
            let gradient = Vec3::AXES.map(|axis| slope(particle, axis));
            Vec3::from(gradient) * -(scale * fabric.inverse_areas()[particle])
        })
        .collect()
}
