//! Takes off the strain that a change of level brings.
//!
//! Between new particles a fold is longer or shorter than the cloth is. Left to the next substep, that
//! strain would become velocity. Here it is taken off the positions alone, by substeps from rest and
//! without loads, each slowed, until hardly more energy is stored than before. Up, one does; down, where
//! folds have no room between the particles that stay, the cloth must find others.

use std::sync::Arc;

use glam::Vec3;

use crate::energy::elastic;
use crate::fabric::{Fabric, FabricMaterial};
use crate::formula::Past;
use crate::lane_batch::LaneBatch;
use crate::lanes::Pack1;
use crate::snapshot::ClothSnapshot;
use crate::step::{Drive, StepSettings};

/// Length of a substep, s. Shorter: it takes more of them. Longer: soft cloth shrinks, for its weight
/// does not hold it.
const STEP: f32 = 1.0 / 120.0;

/// Most substeps: one flag in thirty, the most crumpled, needs more on its way down, and ends with
/// more energy than it had. Fewer: more do. More: it costs time, and the cloth goes farther from where
/// it was.
const MOST_STEPS: u32 = 24;

/// Damping, 1/s: 7 % of the velocity in a substep. Less: the cloth overshoots. More: it creeps.
const DAMPING: f32 = 8.7;

/// The positions with at most so much elastic energy, J, or as near to that as they come.
pub(super) fn settle(
    fabric: &Arc<Fabric>,
    material: &FabricMaterial,
    mut positions: Vec<Vec3>,
    limit: f64,
) -> Vec<Vec3> {
    let mut batch = LaneBatch::<Pack1>::new(Arc::clone(fabric));
    let damped = FabricMaterial { damping: DAMPING, internal_damping: 0.0, ..*material };
    let at_rest = vec![Vec3::ZERO; positions.len()];
    batch.insert(0, &ClothSnapshot::new(positions.clone(), at_rest), damped);
    if let Some(slot) = &mut batch.slots[0] {
        slot.drive = Drive::NONE;
    }
    let settings = StepSettings { passes: 2, ..StepSettings::yarns(MOST_STEPS) };
    batch.begin_tick(STEP * MOST_STEPS as f32, settings);
    for step in 0..MOST_STEPS {
        // Reckoning the energy takes half as long as a substep: after none, one, two, four, eight, …
        if (step == 0 || step.is_power_of_two()) && elastic(fabric, material, &positions) <= limit {
            break;
        }
        if let Some(slot) = &mut batch.slots[0] {
            // Each of first order: a second would foresee the push of the one before.
            slot.past = Past::default();
        }
        batch.integrate();
        batch.solve_constraints();
        batch.update_velocities();
        batch.copy_positions(0, &mut positions);
    }
    positions
}
