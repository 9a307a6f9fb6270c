//! Takes off the strain that a change of level brings.
//!
//! Between new particles a fold is longer or shorter than the cloth is. Left to the next substep, that
//! strain would become velocity. Here it is taken off the positions alone, by substeps from rest and
//! without loads, each slowed, until hardly more energy is stored than before. Up, one does; down, where
//! folds have no room between the particles that stay, the cloth must find others.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::Vec3;

use crate::batch::lane_count::LaneCount;
use crate::batch::snapshot::ClothSnapshot;
use crate::batch::{BatchError, ClothBatch};
use crate::fabric::{Fabric, FabricMaterial};
use crate::geometry::energy::elastic;
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

/// Where cloths of a fabric settle, one after the other.
#[derive(Debug)]
pub(super) struct Settler {
    fabric: Arc<Fabric>,
    batch: Mutex<ClothBatch>,
}

impl Settler {
    pub fn new(fabric: &Arc<Fabric>) -> Self {
        let batch = Mutex::new(ClothBatch::new(Arc::clone(fabric), LaneCount::One));
        Self { fabric: Arc::clone(fabric), batch }
    }

    /// The fabric.
    pub fn fabric(&self) -> &Fabric {
        &self.fabric
    }

    fn lock(&self) -> MutexGuard<'_, ClothBatch> {
        // Whoever panicked left a cloth there, and the next takes its place.
        self.batch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets positions come to at most so much elastic energy, J, or as near to that as they come, and
    /// returns how much it is. Where they are `creased` they have more, which need not be reckoned. What
    /// cannot be simulated stays as it is.
    pub fn settle(
        &self,
        material: &FabricMaterial,
        positions: &mut Vec<Vec3>,
        limit: f64,
        creased: bool,
    ) -> f64 {
        let mut batch = self.lock();
        let damped = FabricMaterial { damping: DAMPING, internal_damping: 0.0, ..*material };
        let begin = ClothSnapshot::new(positions.clone(), vec![Vec3::ZERO; positions.len()]);
        if place(&mut batch, &begin, damped).is_err() {
            return elastic(&self.fabric, material, positions);
        }
        let settings = StepSettings { passes: 2, ..StepSettings::yarns(MOST_STEPS) };
        batch.begin_tick(STEP * MOST_STEPS as f32, settings);
        for step in 0..MOST_STEPS {
            // Reckoning the energy takes half as long as a substep: after none, one, two, four, …
            if (step == 0 && !creased) || step.is_power_of_two() {
                let stored = elastic(&self.fabric, material, positions);
                if stored <= limit {
                    return stored;
                }
            }
            // Each of first order: a second would foresee the push of the one before.
            batch.restart_integrator(0);
            batch.integrate();
            batch.solve_constraints();
            batch.update_velocities();
            batch.copy_positions(0, positions);
        }
        elastic(&self.fabric, material, positions)
    }
}

/// Puts a cloth into a batch, in the place of the one before: what follows from its material alone stays,
/// if that is the same.
fn place(
    batch: &mut ClothBatch,
    state: &ClothSnapshot,
    material: FabricMaterial,
) -> Result<(), BatchError> {
    if batch.is_occupied(0) {
        batch.set_material(0, material)?;
        batch.restore(0, state)
    } else {
        batch.replace(0, state, material)?;
        batch.drive(0, Drive::NONE);
        Ok(())
    }
}
