//! Groups of cloths that are stepped alike, and the assignment of their lanes.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bunting_solver::{Fabric, LaneCount, StepSettings};

use crate::batch::occupancy::{OccupiedBatch, PendingCloth};

/// Number of empty batches of each width that are kept as spares, since making a batch takes longer than a
/// tick. It equals the greatest number of cloths in batches of one lane.
const MOST_SPARE: usize = 3;

/// Cloths of one fabric with equal settings, which are stepped alike.
#[derive(Debug)]
pub(crate) struct Group {
    pub fabric: Arc<Fabric>,
    pub settings: StepSettings,
    pub batches: Vec<OccupiedBatch>,
    /// Empty batches, at most [`MOST_SPARE`] of each width.
    spare: Vec<OccupiedBatch>,
    /// Cloths that wait for a lane.
    pub pending: Vec<PendingCloth>,
    /// Whether cloths have entered or left since the last assignment of lanes.
    pub changed: bool,
}

impl Group {
    /// A group without cloths.
    pub fn new(fabric: &Arc<Fabric>, settings: StepSettings) -> Self {
        Self {
            fabric: Arc::clone(fabric),
            settings,
            batches: Vec::new(),
            spare: Vec::new(),
            pending: Vec::new(),
            changed: true,
        }
    }

    /// Whether cloths with this fabric and these settings belong to the group.
    pub fn is_of(&self, fabric: &Arc<Fabric>, settings: StepSettings) -> bool {
        Arc::ptr_eq(&self.fabric, fabric) && self.settings == settings
    }

    /// Whether the group has neither batches nor pending cloths, and may be replaced.
    pub fn is_empty(&self) -> bool {
        self.batches.is_empty() && self.pending.is_empty()
    }

    /// Assigns a lane to every cloth, in batches of a given width or of widths that suit the number of
    /// cloths. Calls `assigned` with each cloth whose lane changes, its batch and its lane.
    ///
    /// Batches of the wanted widths are kept, the fullest first; all others are dissolved.
    pub fn assign_lanes(
        &mut self,
        width: Option<LaneCount>,
        mut assigned: impl FnMut(Entity, usize, usize),
    ) {
        let occupied: usize = self.batches.iter().map(OccupiedBatch::occupied_count).sum();
        let mut missing = self.widths(occupied + self.pending.len(), width);
        let superfluous = self.superfluous(&mut missing);
        self.dissolve(superfluous, &mut assigned);
        for width in missing {
            let spare = self.spare.iter().position(|spare| spare.width == width);
            self.batches.push(match spare {
                Some(index) => self.spare.swap_remove(index),
                None => OccupiedBatch::new(&self.fabric, width),
            });
        }
        let mut pending = self.pending.drain(..).peekable();
        for (index, batch) in self.batches.iter_mut().enumerate() {
            batch.fill(&mut pending, |entity, lane| assigned(entity, index, lane));
        }
        debug_assert!(pending.peek().is_none(), "the widths hold all cloths");
        drop(pending);
        self.changed = false;
    }

    /// Widths of the batches that hold the given number of cloths.
    fn widths(&self, mut cloths: usize, width: Option<LaneCount>) -> Vec<LaneCount> {
        let mut widths = Vec::new();
        while cloths > 0 {
            let scheme = self.settings.scheme;
            let next = width.unwrap_or_else(|| LaneCount::first_of(cloths, &self.fabric, scheme));
            widths.push(next);
            cloths = cloths.saturating_sub(next.get());
        }
        widths
    }

    /// Indices of the batches whose widths are not wanted, ascending. The widths of the batches that are kept
    /// are removed from `wanted`.
    fn superfluous(&self, wanted: &mut Vec<LaneCount>) -> Vec<usize> {
        let mut fullest_first: Vec<usize> = (0..self.batches.len()).collect();
        fullest_first
            .sort_by_key(|&batch| core::cmp::Reverse(self.batches[batch].occupied_count()));
        let mut superfluous = fullest_first;
        superfluous.retain(|&batch| {
            let fitting = wanted.iter().position(|&width| width == self.batches[batch].width);
            fitting.map(|index| wanted.swap_remove(index)).is_none()
        });
        superfluous.sort_unstable();
        superfluous
    }

    /// Dissolves batches, given by ascending indices, and keeps some as spares. A batch that takes the index
    /// of a dissolved one is reported with all of its cloths.
    fn dissolve(&mut self, batches: Vec<usize>, assigned: &mut impl FnMut(Entity, usize, usize)) {
        for index in batches.into_iter().rev() {
            let mut dissolved = self.batches.swap_remove(index);
            dissolved.dissolve(&mut self.pending);
            let same_width = self.spare.iter().filter(|spare| spare.width == dissolved.width);
            if same_width.count() < MOST_SPARE {
                self.spare.push(dissolved);
            }
            let moved = self.batches.get(index).into_iter().flat_map(OccupiedBatch::occupied);
            for (lane, occupant) in moved {
                assigned(occupant.entity, index, lane);
            }
        }
    }
}
