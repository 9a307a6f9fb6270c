//! The batches that hold the state of all simulated cloths, one cloth a lane.

use std::sync::Arc;
use std::time::Duration;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_platform::time::Instant;
use bevy_tasks::ComputeTaskPool;
#[cfg(feature = "render")]
use bunting_solver::ContactPoint;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, ContactReaction, Fabric, LaneCount, LaneSurface,
    ParticlesMut, PinReaction, StepSettings,
};
use parry3d::bounding_volume::Aabb;

use crate::batch::cost_kind::BatchTiming;
use crate::batch::group::Group;
use crate::batch::lane_handle::LaneHandle;
use crate::batch::occupancy::{LaneMut, OccupiedBatch, PendingCloth};
use crate::batch::parallel::{Work, pays};
use crate::batch::touching::{TouchingCloth, TouchingCloths};

/// The batches that hold the state of all simulated cloths.
#[derive(Resource, Debug, Default)]
pub struct ClothBatches {
    pub(super) groups: Vec<Group>,
    /// Cloths that may touch one another in this tick.
    touching: Vec<TouchingCloths>,
    /// Time that the last [`assign_lanes`](Self::assign_lanes) took.
    pub(crate) assignment_time: Duration,
    /// Whether the time of each batch is measured in this tick.
    pub(crate) is_timed: bool,
}

impl ClothBatches {
    /// Number of batches in use.
    #[must_use]
    pub fn batch_count(&self) -> usize {
        self.groups.iter().map(|group| group.batches.len()).sum()
    }

    /// Number of batches without cloths that are kept for others, for about ten seconds.
    #[must_use]
    pub fn spare_count(&self) -> usize {
        self.groups.iter().map(Group::spare_count).sum()
    }

    /// Drops spare batches that have not been needed for long.
    pub(crate) fn drop_old_spares(&mut self) {
        self.groups.iter_mut().for_each(Group::drop_old_spares);
    }

    /// Drops the fabrics that no living cloth has, and all that is made of them.
    pub(crate) fn drop_unused(&mut self, is_living: impl Fn(&Arc<Fabric>) -> bool) {
        self.groups.iter_mut().for_each(|group| group.drop_unused(&is_living));
        // Lanes are addressed by the indices of their groups, so that only the last groups can be removed.
        while self.groups.pop_if(|group| group.is_empty() && group.fabrics.is_empty()).is_some() {}
    }

    /// Number of substeps in a tick of the batches with the most substeps.
    pub(crate) fn substeps(&self) -> u32 {
        let groups = self.groups.iter().filter(|group| !group.batches.is_empty());
        groups.map(|group| group.settings.substeps).max().unwrap_or(0)
    }

    /// Adds a cloth, which gets a lane at the next [`assign_lanes`](Self::assign_lanes).
    pub(crate) fn add(
        &mut self,
        fabric: &Arc<Fabric>,
        settings: StepSettings,
        cloth: PendingCloth,
    ) {
        let found = self.groups.iter().position(|group| group.is_of(fabric, settings));
        let index = found.unwrap_or_else(|| {
            let kind = self.kind_of(fabric, settings).unwrap_or_else(|| self.unused_kind());
            let group = Group::new(fabric, settings, kind);
            match self.groups.iter().position(Group::is_empty) {
                Some(unused) => {
                    self.groups[unused] = group;
                    unused
                }
                None => {
                    self.groups.push(group);
                    self.groups.len() - 1
                }
            }
        });
        self.groups[index].add(fabric, cloth);
    }

    /// Whether a cloth has entered or left since lanes were assigned.
    pub(crate) fn has_changed(&self) -> bool {
        self.groups.iter().any(|group| group.changed)
    }

    /// Settings of the cloth in a lane.
    pub(crate) fn settings(&self, lane: LaneHandle) -> StepSettings {
        self.groups[lane.group].settings
    }

    /// State in a lane, if the lane holds another cloth than `cloth`.
    pub(crate) fn state_of_other(&self, lane: LaneHandle, cloth: Entity) -> Option<ClothSnapshot> {
        let batch = self.groups.get(lane.group)?.batches.get(lane.batch)?;
        let occupant = batch.occupants.get(lane.lane)?.as_ref()?;
        (occupant.entity != cloth).then(|| batch.batch.snapshot(lane.lane))
    }

    /// Computes the boxes around all cloths in a tick of `tick` seconds.
    pub(crate) fn update_bounds(&mut self, tick: f32) {
        self.spread(Work::Pass, |_| true, |batch| batch.bounds = batch.batch.swept_bounds(tick));
    }

    /// Computes the boxes around all cloths in the batches of some lanes, in a tick of `tick` seconds.
    pub(crate) fn update_bounds_of(&mut self, lanes: &[LaneHandle], tick: f32) {
        let mut batches: Vec<_> = lanes.iter().map(|lane| (lane.group, lane.batch)).collect();
        batches.sort_unstable();
        batches.dedup();
        for (group, batch) in batches {
            let batch = &mut self.groups[group].batches[batch];
            batch.bounds = batch.batch.swept_bounds(tick);
        }
    }

    /// Sets the cloths that may touch one another in this tick, each group by itself.
    pub(crate) fn set_touching(&mut self, groups: &[Vec<TouchingCloth>]) {
        if !self.touching.is_empty() {
            self.groups.iter_mut().for_each(Group::forget_touching);
        }
        self.touching.resize_with(groups.len(), TouchingCloths::default);
        for (touching, cloths) in self.touching.iter_mut().zip(groups) {
            touching.set(cloths);
            for lane in touching.lanes() {
                self.groups[lane.group].batches[lane.batch].touches = true;
            }
        }
    }

    /// The box around all positions that the particles of a cloth reach in this tick, relative to its frame at the
    /// start of the tick, m.
    pub(crate) fn bounds(&self, lane: LaneHandle) -> Option<Aabb> {
        self.groups[lane.group].batches[lane.batch].bounds[lane.lane]
    }

    /// Colliders that the cloth in a lane could touch in the last tick.
    pub(crate) fn near_colliders(&self, lane: LaneHandle) -> impl Iterator<Item = &Collider> {
        self.groups[lane.group].batches[lane.batch].batch.near_colliders(lane.lane)
    }

    /// Where the cloth in a lane touches colliders, and itself unless it is among several cloths, in its frame.
    #[cfg(feature = "render")]
    pub(crate) fn contact_points(&self, lane: LaneHandle) -> Vec<ContactPoint> {
        self.batch(lane).contact_points(lane.lane)
    }

    /// Where the cloth in a lane touches itself and others, if it is among several cloths, in the world.
    #[cfg(feature = "render")]
    pub(crate) fn touching_points(&self, lane: LaneHandle) -> Vec<ContactPoint> {
        let found = self.touching.iter().find_map(|cloths| cloths.contact_points(lane));
        found.unwrap_or_default()
    }

    /// What the cloth in a lane did in the last tick to colliders that asked for it.
    pub(crate) fn reactions(&self, lane: LaneHandle) -> impl Iterator<Item = ContactReaction> {
        self.groups[lane.group].batches[lane.batch].batch.reactions(lane.lane)
    }

    /// What the cloth in a lane did to each group of its pins in the last tick, if that was asked for.
    pub(crate) fn pin_reactions(&self, lane: LaneHandle) -> &[PinReaction] {
        self.batch(lane).pin_reactions(lane.lane)
    }

    /// Impulse of the cloth in a lane in the last tick on each of its holds, N·s.
    pub(crate) fn hold_impulses(&self, lane: LaneHandle) -> &[Vec3] {
        self.batch(lane).hold_impulses(lane.lane)
    }

    /// Removes a cloth from its lane.
    pub(crate) fn remove(&mut self, lane: LaneHandle) -> ClothSnapshot {
        self.free(lane).snapshot(lane.lane)
    }

    /// Removes a cloth from its lane, without the integrator's history, which is valid for this level only.
    pub(crate) fn remove_without_history(&mut self, lane: LaneHandle) -> ClothSnapshot {
        self.free(lane).snapshot_without_history(lane.lane)
    }

    /// Removes a cloth from its lane, with the positions and velocities of some particles only.
    pub(crate) fn remove_particles(
        &mut self,
        lane: LaneHandle,
        particles: &[u32],
    ) -> ClothSnapshot {
        self.free(lane).snapshot_of(lane.lane, particles)
    }

    /// Frees a lane. The cloth's state can be read until another cloth gets the lane.
    fn free(&mut self, lane: LaneHandle) -> &ClothBatch {
        self.groups[lane.group].free(lane.batch, lane.lane)
    }

    /// Gives every pending cloth a lane and closes gaps. Calls `assigned` with each cloth whose lane changes,
    /// and its new lane.
    pub(crate) fn assign_lanes(
        &mut self,
        width: Option<LaneCount>,
        mut assigned: impl FnMut(Entity, LaneHandle),
    ) {
        let began = Instant::now();
        let changed = self.groups.iter_mut().enumerate().filter(|(_, group)| group.changed);
        for (index, group) in changed {
            group.assign_lanes(width, |entity, batch, lane| {
                assigned(entity, LaneHandle { group: index, batch, lane });
            });
        }
        self.assignment_time = began.elapsed();
    }

    /// The cloths in all lanes, each with the surface that [`copy_surfaces`](Self::copy_surfaces) writes.
    pub(crate) fn surfaces(&mut self) -> impl Iterator<Item = (Entity, &mut LaneSurface)> {
        self.batches_where(|_| true).flat_map(|batch| {
            let lanes = batch.occupants.iter().zip(&mut batch.surfaces);
            lanes.filter_map(|(occupant, surface)| Some((occupant.as_ref()?.entity, surface)))
        })
    }

    /// Copies the surfaces of all lanes from the batches.
    pub(crate) fn copy_surfaces(&mut self) {
        self.spread(Work::Pass, |_| true, |batch| batch.batch.copy_surfaces(&mut batch.surfaces));
    }

    /// The batch of a lane.
    pub(crate) fn batch(&self, lane: LaneHandle) -> &ClothBatch {
        &self.groups[lane.group].batches[lane.batch].batch
    }

    /// Write access to a cloth.
    pub(crate) fn lane(&mut self, lane: LaneHandle) -> LaneMut<'_> {
        LaneMut { occupied: &mut self.groups[lane.group].batches[lane.batch], lane: lane.lane }
    }

    /// Particles of a cloth in the current substep, and the fraction of the tick that has passed at the
    /// substep's end. None if the cloth does not take part in the substep.
    pub(crate) fn particles_mut(&mut self, lane: LaneHandle) -> Option<(ParticlesMut<'_>, f32)> {
        let batch = &mut self.groups[lane.group].batches[lane.batch];
        let covered = batch.covered;
        Some((batch.batch.particles_mut(lane.lane)?, covered))
    }

    /// Time that each batch took in the last tick, if it was measured.
    pub(crate) fn timings(&self) -> impl Iterator<Item = BatchTiming> + '_ {
        self.groups.iter().flat_map(|group| {
            group.batches.iter().map(|batch| BatchTiming {
                kind: group.cost_kind(batch),
                time: batch.time.as_secs_f32() * 1e6,
            })
        })
    }

    /// Begins a tick of `tick` seconds in all batches.
    pub(crate) fn begin_tick(&mut self, tick: f32) {
        for group in &mut self.groups {
            let settings = group.settings;
            for batch in &mut group.batches {
                batch.time = Duration::ZERO;
                batch.substeps = settings.substeps;
                batch.batch.begin_tick(tick, settings);
            }
        }
        self.touching.iter_mut().for_each(|cloths| cloths.begin_tick(&mut self.groups));
    }

    /// Begins substep `index` of `count`. A batch with fewer substeps takes part in as many of them as it
    /// has, evenly spread.
    pub(crate) fn begin_substep(&mut self, index: u32, count: u32) {
        for group in &mut self.groups {
            let substeps = group.settings.substeps;
            let done = |index: u32| index * substeps / count;
            let joins = done(index + 1) > done(index);
            let covered = done(index + 1) as f32 / substeps as f32;
            for batch in &mut group.batches {
                batch.joins = joins;
                batch.covered = covered;
            }
        }
    }

    /// Notes where cloths are that may touch one another, before any batch integrates.
    pub(crate) fn begin_touching(&mut self) {
        self.touching.iter_mut().for_each(|cloths| cloths.begin_substep(&mut self.groups));
    }

    /// Keeps cloths apart that may touch one another, after the batches have solved their constraints.
    pub(crate) fn solve_touching(&mut self) {
        self.touching.iter_mut().for_each(|cloths| cloths.solve(&mut self.groups));
    }

    /// Runs a phase on all batches that take part in the current substep.
    pub(crate) fn for_each_joining(&mut self, phase: impl Fn(&mut ClothBatch) + Sync) {
        self.for_each_where(Work::Phase, |batch| batch.joins, |batch| phase(&mut batch.batch));
    }

    /// Computes the normals of all cloths.
    pub(crate) fn compute_normals(&mut self) {
        self.for_each_where(Work::Pass, |_| true, |batch| batch.batch.compute_normals());
    }

    /// Runs all substeps of the tick: batch by batch where no cloth may touch another, then those of the others, each
    /// substep of all of them before the next one.
    pub(crate) fn run_substeps(&mut self) {
        self.for_each_where(
            Work::Tick,
            |batch| !batch.touches,
            |batch| {
                for _ in 0..batch.substeps {
                    batch.batch.integrate();
                    batch.batch.solve_constraints();
                    batch.batch.update_velocities();
                }
            },
        );
        if self.touching.is_empty() {
            return;
        }
        let joins = |batch: &OccupiedBatch| batch.touches && batch.joins;
        let count = self.substeps();
        for index in 0..count {
            self.begin_substep(index, count);
            self.begin_touching();
            self.for_each_where(Work::Phase, joins, |batch| {
                batch.batch.integrate();
                batch.batch.solve_constraints();
            });
            self.solve_touching();
            self.for_each_where(Work::Phase, joins, |batch| batch.batch.update_velocities());
        }
    }

    /// Runs a phase on some batches, and adds its time to theirs if times are measured.
    fn for_each_where(
        &mut self,
        work: Work,
        takes_part: impl Fn(&OccupiedBatch) -> bool,
        phase: impl Fn(&mut OccupiedBatch) + Sync,
    ) {
        let is_timed = self.is_timed;
        self.spread(work, takes_part, |batch| {
            if is_timed {
                let began = Instant::now();
                phase(batch);
                batch.time += began.elapsed();
            } else {
                phase(batch);
            }
        });
    }

    /// Runs work on some batches, on all threads if there is enough of it. The order does not matter, since batches
    /// share no mutable state.
    fn spread(
        &mut self,
        work: Work,
        takes_part: impl Fn(&OccupiedBatch) -> bool,
        run: impl Fn(&mut OccupiedBatch) + Sync,
    ) {
        let pool = ComputeTaskPool::try_get().filter(|pool| pool.thread_num() > 1);
        let pool = pool.filter(|pool| {
            let times = self.groups.iter().flat_map(|group| {
                let batches = group.batches.iter().filter(|batch| takes_part(batch));
                batches.map(|batch| work.time(group.cost_kind(batch)))
            });
            pays(times, pool.thread_num())
        });
        match pool {
            Some(pool) => {
                let run = &run;
                pool.scope(|scope| {
                    for batch in self.batches_where(&takes_part) {
                        scope.spawn(async move { run(batch) });
                    }
                });
            }
            None => self.batches_where(&takes_part).for_each(run),
        }
    }

    fn batches_where(
        &mut self,
        takes_part: impl Fn(&OccupiedBatch) -> bool,
    ) -> impl Iterator<Item = &mut OccupiedBatch> {
        self.groups
            .iter_mut()
            .flat_map(|group| &mut group.batches)
            .filter(move |batch| takes_part(batch))
    }
}
