//! Batches that cloths have left, which are kept for a while.

use std::sync::Arc;

use bunting_solver::Fabric;

use crate::batch::batch_kind::{BatchKind, FabricCount};
use crate::batch::occupancy::OccupiedBatch;

/// Number of spare batches of each kind, since making a batch takes longer than a tick. It equals the greatest
/// number of cloths in batches of one lane.
const MOST_SPARE: usize = 3;

/// Number of times that a spare batch [ages](SpareBatches::age) before it is dropped. Fewer: cloths that change their
/// substeps with every gust get new batches each time. More: batches of cloths that were many once take memory for
/// longer.
const MOST_AGE: u32 = 8;

/// Batches without cloths, at most [`MOST_SPARE`] of each kind.
#[derive(Debug, Default)]
pub(super) struct SpareBatches(Vec<SpareBatch>);

#[derive(Debug)]
struct SpareBatch {
    batch: OccupiedBatch,
    age: u32,
}

impl SpareBatches {
    /// Takes a batch of a kind, in a group of these fabrics.
    pub fn take(&mut self, kind: BatchKind, fabrics: &[FabricCount]) -> Option<OccupiedBatch> {
        let index = self.0.iter().position(|spare| spare.batch.is_of(kind, fabrics))?;
        Some(self.0.swap_remove(index).batch)
    }

    /// Keeps a batch without cloths, unless there are enough of its kind.
    pub fn keep(&mut self, mut batch: OccupiedBatch) {
        batch.touches = false;
        let same_kind = self.0.iter().filter(|spare| spare.batch.is_like(&batch));
        if same_kind.count() < MOST_SPARE {
            self.0.push(SpareBatch { batch, age: 0 });
        }
    }

    /// Number of batches.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Whether there is one for cloths of different fabrics.
    pub fn has_mixed(&self) -> bool {
        self.0.iter().any(|spare| spare.batch.batch.is_mixed())
    }

    /// Makes all batches older, and drops those that have not been taken [`MOST_AGE`] times.
    pub fn age(&mut self) {
        self.0.retain_mut(|spare| {
            spare.age += 1;
            spare.age <= MOST_AGE
        });
    }

    /// Drops batches of fabrics that no living cloth has. Mixed ones go on with a fabric of their topology.
    pub fn drop_unused(&mut self, fabric: &Arc<Fabric>, is_living: impl Fn(&Arc<Fabric>) -> bool) {
        self.0.retain(|SpareBatch { batch: it, .. }| {
            it.batch.is_mixed() || is_living(it.batch.fabric())
        });
        for spare in self.0.iter_mut().filter(|spare| spare.batch.batch.is_mixed()) {
            spare.batch.batch.replace_unused_fabrics(fabric);
        }
    }
}
