//! The batches that hold the state of all cloths, one lane a cloth.

use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use bevy_tasks::ComputeTaskPool;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricMaterial, LaneCount, LaneSurface,
    StepSettings,
};

use crate::lod::Measured;
use crate::seats::{Newcomer, Seats};

/// Particles, counted in all lanes, from which a phase of a substep is worth the 30 µs that it
/// takes to wake other threads.
const PARALLEL_PARTICLES: usize = 64 * 1024;

/// Empty batches of one width that are kept: making one takes longer than a tick. As many as there are
/// cloths that ride alone.
const SPARE: usize = 3;

/// Where the state of a cloth is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Slot {
    group: usize,
    batch: usize,
    lane: usize,
}

/// Cloths that are stepped alike: of one fabric, with the same settings.
#[derive(Debug)]
struct Group {
    fabric: Arc<Fabric>,
    settings: StepSettings,
    batches: Vec<Seats>,
    /// Empty batches, at most [`SPARE`] of each width.
    spare: Vec<Seats>,
    newcomers: Vec<Newcomer>,
    changed: bool,
}

/// All cloths that are simulated.
#[derive(Resource, Debug, Default)]
pub struct ClothBatches {
    groups: Vec<Group>,
    /// Time that the last [`settle`](Self::settle) took.
    pub(crate) settling: Duration,
    /// Whether the time of each batch is measured in this tick.
    pub(crate) measures: bool,
}

/// One cloth in its batch.
pub(crate) struct LaneMut<'a> {
    seats: &'a mut Seats,
    lane: usize,
}

impl LaneMut<'_> {
    pub fn drive(&mut self, drive: Drive) {
        self.seats.batch.drive(self.lane, drive);
    }

    pub fn set_colliders(&mut self, colliders: impl IntoIterator<Item = Collider>) {
        self.seats.batch.set_colliders(self.lane, colliders);
    }

    /// Changes the material, which must be valid.
    pub fn set_material(&mut self, material: FabricMaterial) {
        if self.seats.batch.set_material(self.lane, material).is_ok()
            && let Some((_, kept)) = &mut self.seats.entities[self.lane]
        {
            *kept = material;
        }
    }

    /// Puts the cloth back to rest.
    pub fn rest(&mut self) {
        let rest = ClothSnapshot::at_rest(self.seats.batch.fabric());
        self.seats.batch.restore(self.lane, &rest).expect("a fabric's own rest fits it");
    }
}

impl ClothBatches {
    /// Number of batches in use.
    #[must_use]
    pub fn batch_count(&self) -> usize {
        self.groups.iter().map(|group| group.batches.len()).sum()
    }

    /// Substeps of the finest group.
    pub(crate) fn substeps(&self) -> u32 {
        let substeps = self.groups.iter().filter(|group| !group.batches.is_empty());
        substeps.map(|group| group.settings.substeps).max().unwrap_or(0)
    }

    /// Lets a cloth take a lane at the next [`settle`](Self::settle).
    pub(crate) fn add(&mut self, fabric: &Arc<Fabric>, settings: StepSettings, newcomer: Newcomer) {
        let same = |group: &Group| Arc::ptr_eq(&group.fabric, fabric) && group.settings == settings;
        let found = self.groups.iter().position(same);
        let index = found
            .or_else(|| self.groups.iter().position(Group::is_empty))
            .unwrap_or(self.groups.len());
        if found.is_none() {
            let group = Group {
                fabric: Arc::clone(fabric),
                settings,
                batches: Vec::new(),
                spare: Vec::new(),
                newcomers: Vec::new(),
                changed: true,
            };
            if index == self.groups.len() {
                self.groups.push(group);
            } else {
                self.groups[index] = group;
            }
        }
        self.groups[index].changed = true;
        self.groups[index].newcomers.push(newcomer);
    }

    /// Takes a cloth out of its lane.
    pub(crate) fn take(&mut self, slot: Slot) -> ClothSnapshot {
        self.free(slot).snapshot(slot.lane)
    }

    /// Takes a cloth out of its lane that will not go on at its level.
    pub(crate) fn take_away(&mut self, slot: Slot) -> ClothSnapshot {
        self.free(slot).snapshot_without_history(slot.lane)
    }

    /// Takes a cloth out of its lane that goes on with some of its particles.
    pub(crate) fn take_some(&mut self, slot: Slot, particles: &[u32]) -> ClothSnapshot {
        self.free(slot).snapshot_of(slot.lane, particles)
    }

    /// Frees a lane. The cloth's state is there until someone takes its place.
    fn free(&mut self, slot: Slot) -> &ClothBatch {
        let group = &mut self.groups[slot.group];
        let seats = &mut group.batches[slot.batch];
        group.changed = true;
        seats.entities[slot.lane] = None;
        &seats.batch
    }

    /// Seats newcomers and closes gaps; tells where every cloth is that has taken another lane.
    pub(crate) fn settle(&mut self, lanes: Option<LaneCount>, mut moved: impl FnMut(Entity, Slot)) {
        let began = Instant::now();
        for (index, group) in self.groups.iter_mut().enumerate().filter(|(_, group)| group.changed)
        {
            group.settle(lanes, |entity, batch, lane| {
                moved(entity, Slot { group: index, batch, lane });
            });
        }
        self.settling = began.elapsed();
    }

    /// Everyone who sits in a lane, each with the surface that [`copy_surfaces`](Self::copy_surfaces)
    /// writes.
    pub(crate) fn surfaces(&mut self) -> impl Iterator<Item = (Entity, &mut LaneSurface)> {
        self.joining(|_| true).flat_map(|seats| {
            let lanes = seats.entities.iter().zip(&mut seats.surfaces);
            lanes.filter_map(|(seat, surface)| Some((seat.as_ref()?.0, surface)))
        })
    }

    /// Copies what every lane shows out of its batch.
    pub(crate) fn copy_surfaces(&mut self) {
        self.spread(|_| true, |seats| seats.batch.copy_surfaces(&mut seats.surfaces));
    }

    /// The batch and lane of a cloth.
    #[cfg(test)]
    pub(crate) fn at(&self, slot: Slot) -> (&ClothBatch, usize) {
        (&self.groups[slot.group].batches[slot.batch].batch, slot.lane)
    }

    /// The lane of a cloth, to be written.
    pub(crate) fn lane(&mut self, slot: Slot) -> LaneMut<'_> {
        LaneMut { seats: &mut self.groups[slot.group].batches[slot.batch], lane: slot.lane }
    }

    /// What every batch cost in the last tick, if it was measured.
    pub(crate) fn measured(&self) -> impl Iterator<Item = Measured> + '_ {
        self.groups.iter().flat_map(|group| {
            group.batches.iter().map(|seats| Measured {
                particles: group.fabric.particle_count(),
                settings: group.settings,
                lanes: seats.lanes,
                time: seats.time.as_secs_f32() * 1e6,
            })
        })
    }

    /// Begins a tick of `tick` seconds in all batches.
    pub(crate) fn begin_tick(&mut self, tick: f32) {
        for group in &mut self.groups {
            let settings = group.settings;
            for seats in &mut group.batches {
                seats.time = Duration::ZERO;
                seats.substeps = settings.substeps;
                seats.batch.begin_tick(tick, settings);
            }
        }
    }

    /// Begins substep `index` of `count`: a batch of fewer joins as often as it needs, evenly
    /// spread.
    pub(crate) fn begin_substep(&mut self, index: u32, count: u32) {
        for group in &mut self.groups {
            let done = |index: u32| index * group.settings.substeps / count;
            let joins = done(index + 1) > done(index);
            for seats in &mut group.batches {
                seats.joins = joins;
            }
        }
    }

    /// Does the same with all batches that join in the substep.
    pub(crate) fn for_each_joining(&mut self, phase: impl Fn(&mut ClothBatch) + Sync) {
        self.for_each_where(|seats| seats.joins, |seats| phase(&mut seats.batch));
    }

    /// Does the same with all batches.
    pub(crate) fn for_each(&mut self, phase: impl Fn(&mut ClothBatch) + Sync) {
        self.for_each_where(|_| true, |seats| phase(&mut seats.batch));
    }

    /// Does the same as often as each batch has substeps.
    pub(crate) fn for_each_substep(&mut self, substep: impl Fn(&mut ClothBatch) + Sync) {
        let all = |seats: &mut Seats| (0..seats.substeps).for_each(|_| substep(&mut seats.batch));
        self.for_each_where(|_| true, all);
    }

    /// Does a phase of the tick, and measures it where that is wanted.
    fn for_each_where(
        &mut self,
        joins: impl Fn(&Seats) -> bool,
        phase: impl Fn(&mut Seats) + Sync,
    ) {
        let measures = self.measures;
        self.spread(joins, |seats| {
            if measures {
                let began = Instant::now();
                phase(seats);
                seats.time += began.elapsed();
            } else {
                phase(seats);
            }
        });
    }

    /// On all threads if that pays. Batches share nothing that is written, so the order does not
    /// matter.
    fn spread(&mut self, joins: impl Fn(&Seats) -> bool, work: impl Fn(&mut Seats) + Sync) {
        let particles: usize = self.joining(&joins).map(|seats| seats.particles()).sum();
        let pool = ComputeTaskPool::try_get().filter(|pool| pool.thread_num() > 1);
        match pool {
            Some(pool) if particles >= PARALLEL_PARTICLES => {
                let work = &work;
                pool.scope(|scope| {
                    for seats in self.joining(&joins) {
                        scope.spawn(async move { work(seats) });
                    }
                });
            }
            _ => {
                self.joining(&joins).for_each(work);
            }
        }
    }

    fn joining(&mut self, joins: impl Fn(&Seats) -> bool) -> impl Iterator<Item = &mut Seats> {
        self.groups
            .iter_mut()
            .flat_map(|group| &mut group.batches)
            .filter(move |seats| joins(seats))
    }
}

impl Group {
    fn is_empty(&self) -> bool {
        self.batches.is_empty() && self.newcomers.is_empty()
    }

    /// Full batches first: keeps those that fit, fullest first, dissolves the others, and seats
    /// everyone. Tells who sits in which lane of which batch, of all that did not before.
    fn settle(&mut self, lanes: Option<LaneCount>, mut moved: impl FnMut(Entity, usize, usize)) {
        let seated: usize = self.batches.iter().map(Seats::occupancy).sum();
        let mut missing = self.widths(seated + self.newcomers.len(), lanes);
        let mut fullest: Vec<usize> = (0..self.batches.len()).collect();
        fullest.sort_by_key(|&batch| core::cmp::Reverse(self.batches[batch].occupancy()));
        let mut dissolved = fullest;
        dissolved.retain(|&batch| {
            let fitting = missing.iter().position(|&width| width == self.batches[batch].lanes);
            fitting.map(|index| missing.swap_remove(index)).is_none()
        });
        dissolved.sort_unstable();
        for batch in dissolved.into_iter().rev() {
            let mut seats = self.batches.swap_remove(batch);
            seats.dissolve(&mut self.newcomers);
            if self.spare.iter().filter(|spare| spare.lanes == seats.lanes).count() < SPARE {
                self.spare.push(seats);
            }
            for (lane, (entity, _)) in self.batches.get(batch).into_iter().flat_map(Seats::taken) {
                moved(entity, batch, lane);
            }
        }
        for width in missing {
            let spare = self.spare.iter().position(|spare| spare.lanes == width);
            self.batches.push(match spare {
                Some(index) => self.spare.swap_remove(index),
                None => Seats::new(&self.fabric, width),
            });
        }
        let mut newcomers = self.newcomers.drain(..).peekable();
        for (batch, seats) in self.batches.iter_mut().enumerate() {
            seats.seat(&mut newcomers, |entity, lane| moved(entity, batch, lane));
        }
        debug_assert!(newcomers.peek().is_none(), "there is a lane for everyone");
        drop(newcomers);
        self.changed = false;
    }

    /// Widths of the batches for a number of cloths.
    fn widths(&self, mut cloths: usize, lanes: Option<LaneCount>) -> Vec<LaneCount> {
        let mut widths = Vec::new();
        while cloths > 0 {
            let scheme = self.settings.scheme;
            let width = lanes.unwrap_or_else(|| LaneCount::first_of(cloths, &self.fabric, scheme));
            widths.push(width);
            cloths = cloths.saturating_sub(width.get());
        }
        widths
    }
}
