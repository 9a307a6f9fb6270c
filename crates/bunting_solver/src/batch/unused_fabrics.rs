//! Fabrics of cloths that have left a batch.

use std::sync::Arc;

use crate::batch::cloth_batch::{ClothBatch, Lanes};
use crate::fabric::Fabric;

impl ClothBatch {
    /// Gives the batch itself and its lanes without cloths a fabric of the batch's topology, in place of those of cloths
    /// that have left, so that it keeps these no longer. Only [`mixed`](Self::mixed) batches have more than one fabric. No
    /// bit of a cloth changes.
    pub fn replace_unused_fabrics(&mut self, fabric: &Arc<Fabric>) {
        let Lanes::Mixed(batch) = &mut self.0 else { return };
        debug_assert!(batch.fabric.has_topology_of(fabric), "mixed batches are of one topology");
        batch.fabric = Arc::clone(fabric);
        for lane in 0..batch.lanes.len() {
            if batch.lanes[lane].is_none() {
                batch.set_fabric(lane, fabric);
            }
        }
    }
}
