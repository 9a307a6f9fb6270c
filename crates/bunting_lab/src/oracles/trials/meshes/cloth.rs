//! A cloth of the cases.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, StepLimits, StepSettings,
};
use glam::{DVec3, Vec3};

use crate::{
    product::TICK,
    scenes::{GRAVITY, TICK_RATE},
    stats::mean,
};

/// One cloth, and what it is driven by.
pub(super) struct Cloth {
    pub(super) fabric: Arc<Fabric>,
    pub(super) batch: ClothBatch,
    pub(super) positions: Vec<Vec3>,
}

impl Cloth {
    pub(super) fn new(
        fabric: Arc<Fabric>,
        material: FabricMaterial,
        place: impl Fn(Vec3) -> Vec3,
    ) -> Self {
        let mut start = ClothSnapshot::at_rest(&fabric);
        start.positions.iter_mut().for_each(|at| *at = place(*at));
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&start, material).expect("a lane");
        let mut cloth = Self { fabric, batch, positions: Vec::new() };
        cloth.drive(Drive { air_density: 0.0, ..Drive::default() });
        cloth
    }

    pub(super) fn drive(&mut self, drive: Drive) {
        self.batch.drive(0, drive).expect("a lane");
    }

    pub(super) fn tick(&mut self) {
        self.tick_by(StepLimits::default().of_fabric(&self.fabric, TICK, GRAVITY as f32));
    }

    pub(super) fn tick_by(&mut self, settings: StepSettings) {
        self.batch.step(TICK, settings);
        self.batch.copy_positions(0, &mut self.positions);
    }

    pub(super) fn run(&mut self, seconds: f64) {
        (0..(seconds * f64::from(TICK_RATE)) as usize).for_each(|_| self.tick());
    }

    /// Mean position of the particles that rest where `is_wanted` says, each counted as its area, m.
    pub(super) fn mean(&self, is_wanted: impl Fn(Vec3) -> bool) -> DVec3 {
        let rest = self.fabric.rest_positions().iter().zip(self.fabric.particle_areas());
        let wanted = rest.zip(&self.positions).filter(|((rest, _), _)| is_wanted(**rest));
        let (sum, area) = wanted.fold((DVec3::ZERO, 0.0), |(sum, all), ((_, &area), at)| {
            (sum + at.as_dvec3() * f64::from(area), all + f64::from(area))
        });
        sum / area
    }

    /// Speed over a tick, m/s RMS.
    pub(super) fn speed(&mut self) -> f64 {
        let before = self.positions.clone();
        self.tick();
        let moved =
            self.positions.iter().zip(&before).map(|(now, then)| now.distance_squared(*then));
        let squared: Vec<f64> = moved.map(f64::from).collect();
        mean(&squared).sqrt() * f64::from(TICK_RATE)
    }
}
