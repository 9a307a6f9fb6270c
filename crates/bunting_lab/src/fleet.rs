//! Cloths of one scene, batched as a game would batch them.

use std::sync::Arc;

use bevy_tasks::{TaskPool, TaskPoolBuilder};
use bunting_solver::{ClothBatch, ClothSnapshot, Drive, Fabric, LaneCount, StepSettings};
use glam::Vec3;

use crate::{
    effort::Effort,
    product::{self, TICK},
    scenes::{Scene, TICK_RATE},
    timing::Timing,
};

/// Delay of each cloth's gusts relative to the cloth before it, s, so that no two cloths move alike.
const GUST_LAG: f64 = 0.618;

/// Cloths of one scene, each in its own gusts, side by side in batches.
pub struct Fleet {
    scene: Scene,
    settings: StepSettings,
    batches: Vec<ClothBatch>,
    ticks: u32,
}

impl Fleet {
    /// `cloths` cloths in the scene's initial state, in the widest batches that save time.
    ///
    /// # Panics
    ///
    /// Never: every scene is a valid cloth, and every cloth finds a lane.
    #[must_use]
    pub fn new(scene: Scene, cloths: usize, settings: StepSettings) -> Self {
        Self::of(product::fabric(&scene), scene, cloths, settings)
    }

    /// A fleet with a given fabric of the scene's particles.
    ///
    /// # Panics
    ///
    /// When the fabric's particles are not the scene's.
    #[must_use]
    pub fn of(fabric: Arc<Fabric>, scene: Scene, cloths: usize, settings: StepSettings) -> Self {
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

    /// Puts every cloth into the state of the same cloth in another fleet at another level, and continues in
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

    /// The fabric that all cloths share.
    ///
    /// # Panics
    ///
    /// On a fleet without cloths.
    #[must_use]
    pub fn fabric(&self) -> &Arc<Fabric> {
        self.batches[0].fabric()
    }

    /// Scheme, substeps and passes.
    #[must_use]
    pub fn settings(&self) -> StepSettings {
        self.settings
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

    /// Advances all cloths by `ticks` ticks.
    pub fn advance(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.drive();
            for batch in &mut self.batches {
                batch.step(TICK, self.settings);
            }
        }
    }

    /// Times ticks of all cloths, on this thread alone and on several, alternately so that all see the same
    /// load of the machine. A tick sets the wind, steps and computes normals. As in the plugin, each batch is
    /// a task of a pool, and this thread runs some of the tasks.
    #[must_use]
    pub fn time_ticks(&mut self, cores: &[usize], effort: &Effort) -> Vec<Timing> {
        self.advance(effort.warm_up);
        let repeats = effort.ticks(Timing::repeat(1, 2, || self.advance(1)).median());
        let pools = cores.iter().map(|cores| TaskPoolBuilder::new().num_threads(cores - 1).build());
        let pools: Vec<TaskPool> = pools.collect();
        let mut timings = vec![Timing::default(); pools.len()];
        for _ in 0..repeats {
            for (pool, timing) in pools.iter().zip(&mut timings) {
                timing.time(|| match pool.thread_num() {
                    0 => self.advance(1),
                    _ => self.tick_in(pool),
                });
            }
        }
        timings
    }

    /// Advances all cloths by a tick: batches are tasks of the pool and of this thread.
    fn tick_in(&mut self, pool: &TaskPool) {
        self.ticks += 1;
        let (scene, settings, tick) = (&self.scene, self.settings, self.ticks);
        pool.scope(|scope| {
            let mut first = 0;
            for batch in &mut self.batches {
                let cloth = first;
                first += batch.lane_count();
                scope.spawn(async move {
                    drive(batch, scene, tick, cloth);
                    batch.step(TICK, settings);
                });
            }
        });
    }
}

/// Sets the wind for the cloths of a batch, whose first cloth has number `cloth`. Returns the number after
/// its last cloth.
fn drive(batch: &mut ClothBatch, scene: &Scene, tick: u32, mut cloth: usize) -> usize {
    let seconds = f64::from(tick) / f64::from(TICK_RATE);
    for lane in 0..batch.lane_count() {
        let wind = scene.air.wind_at(seconds + GUST_LAG * cloth as f64).as_vec3();
        let gravity = Vec3::NEG_Y * scene.gravity as f32;
        batch.drive(lane, Drive { gravity, wind, ..Drive::default() }).expect("a good drive");
        cloth += 1;
    }
    cloth
}
