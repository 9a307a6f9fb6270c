//! A cloth at random that is alone, with substeps by need.

use std::{sync::Arc, time::Instant};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, StepLimits, StepSettings,
};
use glam::Vec3;

use crate::{
    need::Need,
    product::{TICK, yarn_strains},
    stats::worse,
};

/// Ticks that are timed, and how many at once.
const TIMED: [usize; 2] = [6, 10];

/// A cloth that is alone, with substeps by need.
pub(super) struct Cloth {
    pub batch: ClothBatch,
    material: FabricMaterial,
    need: Need,
    positions: Vec<Vec3>,
}

impl Cloth {
    /// A cloth in a state.
    pub fn new(fabric: &Arc<Fabric>, start: &ClothSnapshot, material: FabricMaterial) -> Self {
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        batch.insert(start, material).expect("a good cloth");
        let positions = start.positions.clone();
        Self { batch, material, need: Need::within(StepLimits::default()), positions }
    }

    pub fn set_material(&mut self, material: FabricMaterial) {
        self.batch.set_material(0, material).expect("a good material");
        self.material = material;
    }

    /// Some seconds under what drives it.
    pub fn advance(&mut self, seconds: f32, drive: Drive) {
        self.batch.drive(0, drive).expect("a good drive");
        for _ in 0..(seconds / TICK).round() as usize {
            let settings = self.need.settings(self.batch.fabric(), &drive, TICK);
            self.batch.step(TICK, settings);
            let before = self.positions.clone();
            self.batch.copy_positions(0, &mut self.positions);
            self.need.note(&self.batch, &self.material, &drive, [&before, &self.positions], TICK);
        }
    }

    /// The least time of a tick under what acts on it now, s.
    pub fn time_of_tick(&mut self, settings: StepSettings) -> f64 {
        let [blocks, ticks] = TIMED;
        let times = (0..blocks).map(|_| {
            let start = Instant::now();
            (0..ticks).for_each(|_| self.batch.step(TICK, settings));
            start.elapsed().as_secs_f64() / ticks as f64
        });
        let least = times.fold(f64::INFINITY, f64::min);
        self.batch.copy_positions(0, &mut self.positions);
        least
    }

    /// Strains of the links along warp and weft.
    pub fn strains(&self) -> impl Iterator<Item = f64> {
        yarn_strains(self.batch.fabric(), &self.positions)
    }

    pub fn greatest_stretch(&self) -> f64 {
        self.strains().fold(0.0, worse)
    }
}
