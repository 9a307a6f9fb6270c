//! One cloth of any fabric, with substeps by need.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, StepLimits,
};
use glam::Vec3;

use crate::{
    need::Need,
    product::{TICK, rms_speed},
    scenes::ticks,
    stats::worse,
};

/// Time at the end of a run in which the greatest speed counts, s.
const LATE: f64 = 1.0;

/// A cloth that is alone.
pub(super) struct Lone {
    pub batch: ClothBatch,
    pub positions: Vec<Vec3>,
    material: FabricMaterial,
    drive: Drive,
    need: Need,
}

impl Lone {
    /// A cloth in a state.
    pub fn new(
        fabric: &Arc<Fabric>,
        start: &ClothSnapshot,
        material: FabricMaterial,
        drive: Drive,
    ) -> Self {
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        batch.insert(start, material).expect("a good cloth");
        batch.drive(0, drive).expect("a good drive");
        let positions = start.positions.clone();
        let need = Need::default().beginning_at(fabric, &material, &positions);
        Self { batch, positions, material, drive, need }
    }

    /// The cloth within other limits.
    pub fn within(self, limits: StepLimits) -> Self {
        let need = Need::within(limits);
        let need = need.beginning_at(self.batch.fabric(), &self.material, &self.positions);
        Self { need, ..self }
    }

    pub fn tick(&mut self) {
        let settings = self.need.settings(self.batch.fabric(), &self.drive, TICK);
        self.batch.step(TICK, settings);
        let before = self.positions.clone();
        self.batch.copy_positions(0, &mut self.positions);
        self.need.note(&self.batch, &self.material, &self.drive, [&before, &self.positions], TICK);
    }

    pub fn run(&mut self, seconds: f64) {
        (0..ticks(seconds)).for_each(|_| self.tick());
    }

    /// The greatest RMS speed in the last second of a run, m/s.
    pub fn late_speed(&mut self, seconds: f64) -> f64 {
        self.run(seconds - LATE);
        (0..ticks(LATE)).fold(0.0, |most, _| {
            self.tick();
            worse(most, rms_speed(&self.batch, 0))
        })
    }
}
