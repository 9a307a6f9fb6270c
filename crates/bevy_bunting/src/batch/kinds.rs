//! Kinds of cloths: what could lie in one batch if it took the same number of substeps.

use std::sync::Arc;

use bunting_solver::{Fabric, StepSettings};

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;

impl ClothBatches {
    /// Number of the kind of cloths with a fabric and settings, whatever their substeps; none if there were none yet.
    pub(crate) fn kind_of(&self, fabric: &Arc<Fabric>, settings: StepSettings) -> Option<usize> {
        let alike = self.groups.iter().find(|group| group.is_of_kind(fabric, settings));
        alike.map(|group| group.kind)
    }

    /// Number of the kind of the cloth in a lane.
    pub(crate) fn kind(&self, lane: LaneHandle) -> usize {
        self.groups[lane.group].kind
    }

    /// The least number that no group's kind has.
    pub(super) fn unused_kind(&self) -> usize {
        let is_used = |kind: &usize| self.groups.iter().any(|group| group.kind == *kind);
        (0..).find(|kind| !is_used(kind)).unwrap_or_default()
    }
}
