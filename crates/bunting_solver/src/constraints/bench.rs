//! A batch of one cloth for tests of single constraints.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::exchange::Entering;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Positions;
use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Fabric, FabricMaterial};
use crate::simd::registers::Pack1;
use crate::simd::vec3::{lane3, set_lane3};
use crate::step::StepSettings;

/// Length of the substep, s.
pub(in crate::constraints) const STEP: f32 = 1.0 / 120.0;

/// A batch of one cloth at the given positions, in a substep of backward Euler.
pub(in crate::constraints) fn cloth_at(
    fabric: &Fabric,
    material: FabricMaterial,
    positions: &[Vec3],
) -> LaneBatch<Pack1> {
    let mut batch = LaneBatch::side_by_side(Arc::new(fabric.clone()));
    let (fabric, snapshot) = (&Arc::clone(&batch.fabric), &ClothSnapshot::at_rest(fabric));
    batch.exchange(&[], &[Entering { lane: 0, fabric, snapshot, material }]);
    batch.begin_tick(STEP, StepSettings::gauss_seidel(1));
    batch.begin_substep();
    for (pack, &position) in batch.positions.packs_mut().iter_mut().zip(positions) {
        set_lane3(pack, 0, position);
    }
    batch
}

/// Positions of the particles, m.
pub(in crate::constraints) fn positions(batch: &LaneBatch<Pack1>) -> Vec<Vec3> {
    batch.positions.packs().iter().map(|pack| lane3(pack, 0)).collect()
}

/// Displacement of each particle by an implicit step of an energy that is soft compared with inertia,
/// −w h²/σ ∂E/∂x, m, by central differences.
pub(in crate::constraints) fn soft_step(
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
