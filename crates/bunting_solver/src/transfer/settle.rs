//! Settling: removal of the strain that a change of level brings.
//!
//! Between interpolated particles a fold is longer or shorter than the cloth at rest. The next substep would
//! turn this strain into velocity. Settling removes it from the positions alone, by damped substeps from rest
//! and without loads, until the elastic energy hardly exceeds that before the change. One substep is enough
//! after a change to more particles; after a change to fewer, where a fold may be narrower than the distance
//! of two particles, the cloth must find other folds.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::Vec3;

use crate::batch::lane_count::LaneCount;
use crate::batch::snapshot::ClothSnapshot;
use crate::batch::{BatchError, ClothBatch};
use crate::fabric::{Fabric, FabricMaterial};
use crate::geometry::energy::elastic;
use crate::step::{Drive, StepSettings};

/// Length of a substep, s. Shorter: settling takes more substeps. Longer: soft cloth shrinks, since no weight
/// holds its stretch here.
const STEP: f32 = 1.0 / 120.0;

/// Greatest number of substeps. One flag in thirty, the most crumpled, needs more on its way down, and ends
/// with more energy than before. Fewer: more flags do so. More: settling costs time, and the cloth moves
/// farther from its position.
const MOST_STEPS: u32 = 24;

/// Damping, 1/s: it removes 7 % of the velocity in a substep. Less: the cloth overshoots. More: settling
/// takes longer.
const DAMPING: f32 = 8.7;

/// A fabric and a batch of one lane, in which cloths of the fabric settle one after the other.
#[derive(Debug)]
pub(super) struct Settler {
    fabric: Arc<Fabric>,
    batch: Mutex<ClothBatch>,
}

impl Settler {
    pub fn new(fabric: &Arc<Fabric>) -> Arc<Self> {
        let batch = Mutex::new(ClothBatch::new(Arc::clone(fabric), LaneCount::One));
        Arc::new(Self { fabric: Arc::clone(fabric), batch })
    }

    /// The fabric.
    pub fn fabric(&self) -> &Fabric {
        &self.fabric
    }

    fn lock(&self) -> MutexGuard<'_, ClothBatch> {
        // The next cloth replaces all state that a panic may have left behind.
        self.batch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Settles positions (m) until the elastic energy is at most `limit` joules, or the substeps are used up.
    /// Returns the elastic energy then, J. For `folded` positions the first energy is not computed, since it
    /// exceeds the limit. With an invalid material the positions stay unchanged.
    pub fn settle(
        &self,
        material: &FabricMaterial,
        positions: &mut Vec<Vec3>,
        limit: f64,
        folded: bool,
    ) -> f64 {
        let mut batch = self.lock();
        let damped = FabricMaterial { damping: DAMPING, internal_damping: 0.0, ..*material };
        let begin = ClothSnapshot::new(positions.clone(), vec![Vec3::ZERO; positions.len()]);
        if insert(&mut batch, &begin, damped).is_err() {
            return elastic(&self.fabric, material, positions);
        }
        let settings = StepSettings { passes: 2, ..StepSettings::yarns(1) };
        for step in 0..MOST_STEPS {
            // Computing the energy takes half as long as a substep, so it is computed only after 0, 1, 2, 4,
            // … substeps.
            if (step == 0 && !folded) || step.is_power_of_two() {
                let stored = elastic(&self.fabric, material, positions);
                if stored <= limit {
                    return stored;
                }
            }
            // Every substep is of first order, which extrapolates no correction of the one before.
            batch.begin_tick(STEP, settings);
            batch.restart_integrator(0);
            batch.integrate();
            batch.solve_constraints();
            batch.update_velocities();
            batch.copy_positions(0, positions);
        }
        elastic(&self.fabric, material, positions)
    }
}

/// Replaces the cloth in the batch's lane. The parameters of a material are kept if the next cloth has the
/// same material.
fn insert(
    batch: &mut ClothBatch,
    state: &ClothSnapshot,
    material: FabricMaterial,
) -> Result<(), BatchError> {
    if batch.is_occupied(0) {
        batch.set_material(0, material)?;
        batch.restore(0, state)
    } else {
        batch.replace(0, state, material)?;
        batch.drive(0, Drive::NONE)
    }
}
