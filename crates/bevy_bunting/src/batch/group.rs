//! Groups of cloths that are stepped alike, and the assignment of their lanes.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bunting_solver::{ClothBatch, Fabric, LaneCount, Scheme, StepSettings};

use crate::background::Background;
use crate::batch::batch_kind::{BatchKind, FabricCount, wanted_batches};
use crate::batch::cost_kind::CostKind;
use crate::batch::occupancy::{OccupiedBatch, PendingCloth};
use crate::batch::spare::SpareBatches;

/// Number of free lanes of mixed batches below which another thread builds the next such batch. Fewer: a tick in
/// which several cloths arrive waits for it. More: groups have a batch too many more often.
const FEW_FREE: usize = 3;

/// Cloths of fabrics of one topology with the same settings, which are stepped alike.
#[derive(Debug)]
pub(crate) struct Group {
    pub settings: StepSettings,
    /// Number of what its cloths are but for their substeps: groups of one kind differ in these only.
    pub kind: usize,
    /// Fabrics of one topology, that of the first. A new fabric replaces one without cloths.
    pub fabrics: Vec<FabricCount>,
    pub batches: Vec<OccupiedBatch>,
    /// Batches that cloths have left.
    spare: SpareBatches,
    /// The next mixed batch, which another thread builds. The bits of a cloth do not depend on its batch.
    next_mixed: Option<Background<OccupiedBatch>>,
    /// Cloths that wait for a lane.
    pub pending: Vec<PendingCloth>,
    /// Whether cloths have entered or left since the last assignment of lanes.
    pub changed: bool,
}

impl Group {
    /// A group without cloths.
    pub fn new(fabric: &Arc<Fabric>, settings: StepSettings, kind: usize) -> Self {
        Self {
            settings,
            kind,
            fabrics: vec![FabricCount { fabric: Arc::clone(fabric), cloths: 0 }],
            batches: Vec::new(),
            spare: SpareBatches::default(),
            next_mixed: None,
            pending: Vec::new(),
            changed: true,
        }
    }

    /// Whether cloths with this fabric and these settings belong to the group.
    pub fn is_of(&self, fabric: &Arc<Fabric>, settings: StepSettings) -> bool {
        self.settings == settings && self.is_of_kind(fabric, settings)
    }

    /// Whether cloths with this fabric and these settings, but for their substeps, belong to groups of this kind.
    pub fn is_of_kind(&self, fabric: &Arc<Fabric>, settings: StepSettings) -> bool {
        let Some(FabricCount { fabric: first, .. }) = self.fabrics.first() else { return false };
        let as_many = StepSettings { substeps: self.settings.substeps, ..settings };
        self.settings == as_many
            && (Arc::ptr_eq(first, fabric)
                || (settings.scheme == Scheme::Yarns && first.has_topology_of(fabric)))
    }

    /// Whether the group has neither batches nor pending cloths, and may be replaced.
    pub fn is_empty(&self) -> bool {
        self.batches.is_empty() && self.pending.is_empty()
    }

    /// Adds a cloth that waits for a lane.
    pub fn add(&mut self, fabric: &Arc<Fabric>, cloth: PendingCloth) {
        let known = self.fabrics.iter().position(|it| Arc::ptr_eq(&it.fabric, fabric));
        let index = known.unwrap_or_else(|| {
            let new = FabricCount { fabric: Arc::clone(fabric), cloths: 0 };
            match self.fabrics.iter().position(|it| it.cloths == 0) {
                Some(unused) => {
                    self.fabrics[unused] = new;
                    unused
                }
                None => {
                    self.fabrics.push(new);
                    self.fabrics.len() - 1
                }
            }
        });
        self.fabrics[index].cloths += 1;
        self.changed = true;
        self.pending.push(PendingCloth { fabric: index, ..cloth });
    }

    /// Frees a lane. The cloth's state can be read until another cloth gets the lane.
    pub fn free(&mut self, batch: usize, lane: usize) -> &ClothBatch {
        self.changed = true;
        let batch = &mut self.batches[batch];
        if let Some(occupant) = batch.occupants[lane].take() {
            self.fabrics[occupant.fabric].cloths -= 1;
        }
        &batch.batch
    }

    /// Forgets which batches have cloths that may touch others.
    pub fn forget_touching(&mut self) {
        self.batches.iter_mut().for_each(|batch| batch.touches = false);
    }

    /// What the cost of one of the batches depends on.
    pub fn cost_kind(&self, batch: &OccupiedBatch) -> CostKind {
        CostKind {
            particles: batch.batch.fabric().particle_count(),
            settings: self.settings,
            lanes: batch.width,
            mixed: batch.batch.is_mixed(),
        }
    }

    /// Assigns a lane to every cloth, in batches of a given width or of the widths that suit the number
    /// of cloths. Calls `assigned` with each cloth whose lane is another, its batch and its lane.
    ///
    /// Batches of the wanted kinds are kept, the fullest first; the others are dissolved.
    pub fn assign_lanes(
        &mut self,
        width: Option<LaneCount>,
        mut assigned: impl FnMut(Entity, usize, usize),
    ) {
        let fullest_first = self.fullest_first();
        let singles = fullest_first.iter().filter_map(|&batch| {
            let batch = &self.batches[batch];
            (batch.width == LaneCount::One).then(|| batch.batch.fabric())
        });
        let mut missing = wanted_batches(&self.fabrics, width, self.settings.scheme, singles);
        let superfluous = self.superfluous(fullest_first, &mut missing);
        self.dissolve(superfluous, &mut assigned);
        for kind in missing {
            let batch = self.new_batch(kind);
            self.batches.push(batch);
        }
        self.move_out_of_mixed();
        // Batches of one fabric first: mixed ones hold what is left.
        for mixed in [false, true] {
            for (index, batch) in self.batches.iter_mut().enumerate() {
                if batch.batch.is_mixed() == mixed {
                    batch.fill(&mut self.pending, &self.fabrics, |entity, lane| {
                        assigned(entity, index, lane);
                    });
                }
            }
        }
        debug_assert!(self.pending.is_empty(), "the batches hold all cloths");
        self.changed = false;
        if width.is_none() {
            self.build_ahead();
        }
    }

    /// A batch without cloths: a spare one, the one that was built ahead, or a new one.
    fn new_batch(&mut self, kind: BatchKind) -> OccupiedBatch {
        if let Some(spare) = self.spare.take(kind, &self.fabrics) {
            return spare;
        }
        let ahead = if kind.fabric.is_none() { self.next_mixed.take() } else { None };
        ahead.map_or_else(|| OccupiedBatch::new(kind, &self.fabrics), Background::take)
    }

    /// Begins to build the next mixed batch in the background if the next few cloths may need it. Building one takes
    /// as long as many of its ticks.
    fn build_ahead(&mut self) {
        let in_use = self.fabrics.iter().filter(|it| it.cloths > 0).count();
        let mixed = || self.batches.iter().filter(|batch| batch.batch.is_mixed());
        let free: usize = mixed().map(|it| it.occupants.len() - it.occupied_count()).sum();
        let is_shared = |it: &OccupiedBatch| it.batch.is_mixed() || it.width == LaneCount::One;
        let has_rest = self.batches.iter().any(is_shared);
        let has_next = self.spare.has_mixed() || self.next_mixed.is_some();
        if in_use < 2 || !has_rest || free >= FEW_FREE || has_next {
            return;
        }
        let fabric = FabricCount { fabric: Arc::clone(&self.fabrics[0].fabric), cloths: 0 };
        self.next_mixed =
            Some(Background::begin(move || OccupiedBatch::new(BatchKind::MIXED, &[fabric])));
    }

    /// Number of batches that cloths have left, and that are kept for others.
    pub fn spare_count(&self) -> usize {
        self.spare.count() + usize::from(self.next_mixed.is_some())
    }

    /// Drops spare batches that have not been needed for long.
    pub fn drop_old_spares(&mut self) {
        self.spare.age();
    }

    /// Drops the fabrics that no living cloth has, and all that is made of them.
    pub fn drop_unused(&mut self, is_living: impl Fn(&Arc<Fabric>) -> bool) {
        for index in (0..self.fabrics.len()).rev() {
            let FabricCount { fabric, cloths } = &self.fabrics[index];
            if *cloths == 0 && !is_living(fabric) {
                self.remove_fabric(index);
            }
        }
        // It may be of a fabric that is gone; a spare one is as good.
        if self.next_mixed.as_ref().is_some_and(Background::is_done)
            && let Some(next) = self.next_mixed.take()
        {
            self.spare.keep(next.take());
        }
        let in_use = self.fabrics.iter().find(|it| it.cloths > 0).or(self.fabrics.first());
        let Some(FabricCount { fabric, .. }) = in_use else {
            (self.spare, self.next_mixed) = (SpareBatches::default(), None);
            return;
        };
        self.spare.drop_unused(fabric, is_living);
        for batch in self.batches.iter_mut().filter(|batch| batch.batch.is_mixed()) {
            batch.batch.replace_unused_fabrics(fabric);
        }
    }

    /// Removes a fabric without cloths. The last fabric gets its index.
    fn remove_fabric(&mut self, index: usize) {
        self.fabrics.swap_remove(index);
        let moved = self.fabrics.len();
        let occupants = self.batches.iter_mut().flat_map(|batch| batch.occupants.iter_mut());
        let of_occupants = occupants.flatten().map(|occupant| &mut occupant.fabric);
        let of_pending = self.pending.iter_mut().map(|cloth| &mut cloth.fabric);
        for fabric in of_occupants.chain(of_pending).filter(|fabric| **fabric == moved) {
            *fabric = index;
        }
    }

    /// Indices of the batches, the fullest first.
    fn fullest_first(&self) -> Vec<usize> {
        let mut batches: Vec<usize> = (0..self.batches.len()).collect();
        batches.sort_by_key(|&batch| core::cmp::Reverse(self.batches[batch].occupied_count()));
        batches
    }

    /// Indices of the batches whose kinds are not wanted, ascending. The kinds of the other batches
    /// are taken off the list of wanted ones.
    fn superfluous(&self, fullest_first: Vec<usize>, wanted: &mut Vec<BatchKind>) -> Vec<usize> {
        let mut superfluous = fullest_first;
        superfluous.retain(|&batch| {
            let batch = &self.batches[batch];
            let fitting = wanted.iter().position(|&kind| batch.is_of(kind, &self.fabrics));
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
            self.spare.keep(dissolved);
            let moved = self.batches.get(index).into_iter().flat_map(OccupiedBatch::occupied);
            for (lane, occupant) in moved {
                assigned(occupant.entity, index, lane);
            }
        }
    }

    /// Takes cloths out of mixed batches for which batches of their own fabric have room.
    fn move_out_of_mixed(&mut self) {
        if self.fabrics.len() == 1 {
            return;
        }
        // Lanes of each fabric's own batches, less the cloths that are in them or wait.
        let mut room = vec![0_isize; self.fabrics.len()];
        let own = self.batches.iter().filter(|batch| !batch.batch.is_mixed());
        for batch in own {
            let is_of = |it: &FabricCount| Arc::ptr_eq(&it.fabric, batch.batch.fabric());
            if let Some(fabric) = self.fabrics.iter().position(is_of) {
                room[fabric] += (batch.occupants.len() - batch.occupied_count()) as isize;
            }
        }
        for cloth in &self.pending {
            room[cloth.fabric] -= 1;
        }
        if room.iter().all(|&room| room <= 0) {
            return;
        }
        for batch in self.batches.iter_mut().filter(|batch| batch.batch.is_mixed()) {
            batch.take_out(&mut self.pending, |fabric| {
                let has_room = room[fabric] > 0;
                room[fabric] -= isize::from(has_room);
                has_room
            });
        }
    }
}
