//! Several cloths, each in a batch of its own, that are kept apart, and the triangles that intersect.

use std::{sync::Arc, time::Duration, time::Instant};

use bunting_solver::{
    ClothBatch, ClothGroup, ClothSnapshot, Collider, Drive, Fabric, FabricMaterial, FrameMotion,
    GroupLanes, GroupMember, LaneCount, SelfCollision,
};
use glam::{Quat, Vec3};

use crate::{
    contacts::intersections::intersecting_pairs,
    product::{DEFAULT, TICK},
};

/// Distance of cloths and of layers, m.
const APART: f32 = 5e-3;

struct Batches(Vec<ClothBatch>);

impl GroupLanes for Batches {
    fn lane(&mut self, member: usize) -> (&mut ClothBatch, usize) {
        (&mut self.0[member], 0)
    }
}

/// Several cloths.
pub(super) struct Together {
    batches: Batches,
    group: Option<ClothGroup>,
    members: Vec<GroupMember>,
    time: Duration,
    ticks: u32,
    /// Ticks with an intersection at their end.
    pub with_any: u32,
    /// Most pairs in a tick.
    pub most: usize,
    /// Pairs in the last tick.
    pub last: usize,
}

impl Together {
    /// No cloths yet, which are kept apart or not.
    pub fn new(apart: bool) -> Self {
        Self {
            batches: Batches(Vec::new()),
            group: apart.then(ClothGroup::default),
            members: Vec::new(),
            time: Duration::ZERO,
            ticks: 0,
            with_any: 0,
            most: 0,
            last: 0,
        }
    }

    /// Adds a cloth whose frame rests at a position, m.
    pub fn add(
        &mut self,
        fabric: &Arc<Fabric>,
        start: &ClothSnapshot,
        material: FabricMaterial,
        at: Vec3,
        colliders: impl IntoIterator<Item = Collider>,
    ) {
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        batch.insert(start, material).expect("a good cloth");
        batch.set_colliders(0, colliders).expect("good colliders");
        if self.group.is_some() {
            let layers = SelfCollision { thickness: APART };
            batch.set_self_collision(0, Some(layers)).expect("a good thickness");
        }
        self.batches.0.push(batch);
        self.members.push(GroupMember {
            thickness: APART,
            memberships: 1,
            filters: 1,
            start: (at, Quat::IDENTITY),
            motion: FrameMotion::NONE,
            carrier: Vec3::ZERO,
        });
    }

    /// Advances by a tick, all cloths under the same drive.
    pub fn tick(&mut self, drive: Drive) {
        let began = Instant::now();
        let Self { batches, group, members, .. } = self;
        for batch in &mut batches.0 {
            batch.drive(0, drive).expect("a good drive");
            batch.begin_tick(TICK, DEFAULT);
        }
        if let Some(group) = group {
            group.set_members(members, batches);
        }
        for _ in 0..DEFAULT.substeps {
            if let Some(group) = group {
                group.begin_substep(batches);
            }
            for batch in &mut batches.0 {
                batch.integrate();
                batch.solve_constraints();
            }
            if let Some(group) = group {
                group.solve(batches);
            }
            batches.0.iter_mut().for_each(ClothBatch::update_velocities);
        }
        self.time += began.elapsed();
        self.ticks += 1;
        self.note();
    }

    /// Counts the pairs at the end of a tick.
    fn note(&mut self) {
        let (mut triangles, mut positions) = (Vec::new(), Vec::new());
        let mut of_cloth = Vec::new();
        for (batch, member) in self.batches.0.iter().zip(&self.members) {
            let first = positions.len() as u32;
            let own = batch.fabric().triangles().iter();
            triangles.extend(own.map(|triangle| triangle.map(|corner| corner + first)));
            batch.copy_positions(0, &mut of_cloth);
            positions.extend(of_cloth.iter().map(|&at| member.start.0 + at));
        }
        self.last = intersecting_pairs(&triangles, &positions);
        self.most = self.most.max(self.last);
        self.with_any += u32::from(self.last > 0);
    }

    /// Part of the ticks that ended with an intersection.
    pub fn part(&self) -> f64 {
        f64::from(self.with_any) / f64::from(self.ticks.max(1))
    }

    /// Greatest speed of a particle, m/s.
    pub fn speed(&self) -> f64 {
        let of = |batch: &ClothBatch| batch.snapshot(0).velocities;
        let speeds = self.batches.0.iter().flat_map(of).map(|velocity| velocity.length());
        f64::from(speeds.fold(0.0, f32::max))
    }

    /// Mean time of a tick, µs.
    pub fn us(&self) -> f64 {
        1e6 * self.time.as_secs_f64() / f64::from(self.ticks.max(1))
    }
}
