//! Cloths of one scene, batched as a game would batch them.

use std::{
    sync::{Arc, Barrier},
    thread,
};

use bunting_solver::{ClothBatch, ClothSnapshot, Drive, Fabric, LaneCount, StepSettings};
use glam::Vec3;

use crate::{
    budget::Effort,
    product::{self, TICK},
    scenes::{Scene, TICK_RATE},
    timing::Timing,
};

/// By how much later each cloth meets the gusts than the one before it, s, so that no two move alike.
const GUST_LAG: f64 = 0.618;

/// Cloths of one scene, each in gusts of its own, side by side in batches.
pub struct Fleet {
    scene: Scene,
    settings: StepSettings,
    batches: Vec<ClothBatch>,
    ticks: u32,
}

impl Fleet {
    /// `cloths` cloths as the scene begins, in the widest batches that pay.
    ///
    /// # Panics
    ///
    /// Never: every scene is a good cloth, and every cloth finds its lane.
    #[must_use]
    pub fn new(scene: Scene, cloths: usize, settings: StepSettings) -> Self {
        let fabric = product::fabric(&scene);
        let positions: Vec<Vec3> = scene.positions().iter().map(|x| x.as_vec3()).collect();
        let velocities = vec![Vec3::ZERO; positions.len()];
        let start = ClothSnapshot::new(positions, velocities);
        let mut batches = Vec::new();
        let mut left = cloths;
        while left > 0 {
            let lanes = LaneCount::holding(left);
            let mut batch = ClothBatch::new(fabric.clone(), lanes);
            for _ in 0..left.min(lanes.get()) {
                batch.insert(&start, product::material(&scene)).expect("a free lane");
            }
            left -= left.min(lanes.get());
            batches.push(batch);
        }
        Self { scene, settings, batches, ticks: 0 }
    }

    /// State of every cloth.
    pub fn snapshots(&self) -> impl Iterator<Item = ClothSnapshot> + '_ {
        self.batches.iter().flat_map(|batch| batch.occupied().map(|lane| batch.snapshot(lane)))
    }

    /// Puts every cloth into the state that it has in another fleet at another level, and goes on in
    /// the same wind.
    ///
    /// # Panics
    ///
    /// When the other fleet has fewer cloths, or `convert` makes a state of another fabric.
    pub fn take_over(&mut self, other: &Self, convert: impl Fn(&ClothSnapshot) -> ClothSnapshot) {
        self.ticks = other.ticks;
        let mut states = other.snapshots();
        for batch in &mut self.batches {
            for lane in batch.occupied().collect::<Vec<_>>() {
                let state = convert(&states.next().expect("as many cloths"));
                batch.restore(lane, &state).expect("a state of the fabric");
            }
        }
    }

    /// The fabric that all are cut from.
    ///
    /// # Panics
    ///
    /// On a fleet of no cloths.
    #[must_use]
    pub fn fabric(&self) -> &Arc<Fabric> {
        self.batches[0].fabric()
    }

    /// The batches.
    pub fn batches_mut(&mut self) -> &mut [ClothBatch] {
        &mut self.batches
    }

    /// Sets the wind of the next tick for each cloth.
    pub fn drive(&mut self) {
        self.ticks += 1;
        let (scene, tick) = (&self.scene, self.ticks);
        let mut cloth = 0;
        for batch in &mut self.batches {
            cloth = drive(batch, scene, tick, cloth);
        }
    }

    /// Advances all by `ticks` ticks.
    pub fn advance(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.drive();
            for batch in &mut self.batches {
                batch.step(TICK, self.settings);
            }
        }
    }

    /// Times ticks of all cloths on `cores` threads, each of which keeps its batches. A tick sets the
    /// wind, steps and computes normals; all threads wait for one another before and after it.
    #[must_use]
    pub fn time_ticks(&mut self, cores: usize, effort: &Effort) -> Timing {
        self.advance(effort.warm_up);
        let mut timing = Timing::repeat(1, 2, || self.advance(1));
        let repeats = effort.ticks(timing.median());
        let share = self.batches.len().div_ceil(cores);
        let (scene, settings, first_tick) = (&self.scene, self.settings, self.ticks);
        let mut shares: Vec<&mut [ClothBatch]> = self.batches.chunks_mut(share).collect();
        let barrier = Barrier::new(shares.len());
        let tick = |batches: &mut [ClothBatch], repeat: usize| {
            let mut cloth = 0;
            for batch in batches {
                cloth = drive(batch, scene, first_tick + repeat as u32, cloth);
                batch.step(TICK, settings);
            }
            barrier.wait();
        };
        timing = Timing::default();
        thread::scope(|scope| {
            let (own, others) = shares.split_first_mut().expect("a fleet has cloths");
            for batches in others {
                scope.spawn(|| {
                    for repeat in 0..repeats {
                        barrier.wait();
                        tick(batches, repeat);
                    }
                });
            }
            for repeat in 0..repeats {
                barrier.wait();
                timing.time(|| tick(own, repeat));
            }
        });
        timing
    }
}

/// Sets the wind for the cloths of a batch, the first of which is number `cloth`; returns the number
/// of the next.
fn drive(batch: &mut ClothBatch, scene: &Scene, tick: u32, mut cloth: usize) -> usize {
    let seconds = f64::from(tick) / f64::from(TICK_RATE);
    for lane in 0..batch.lane_count() {
        let wind = scene.air.wind_at(seconds + GUST_LAG * cloth as f64).as_vec3();
        let gravity = Vec3::NEG_Y * scene.gravity as f32;
        batch.drive(lane, Drive { gravity, wind, ..Drive::default() });
        cloth += 1;
    }
    cloth
}
