//! Flags in gusty wind: strain, mean place and speed, and what they cost, with fixed substeps and by need.

use std::{sync::Arc, time::Instant};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    LinkFamily, StepLimits, StepSettings,
};
use glam::Vec3;
use serde::Serialize;

use crate::{
    need::Need,
    product::TICK,
    scenes::ticks,
    stats::{Strain, rms_length},
};

/// Time before anything is measured, s.
const SETTLING: f64 = 2.0;
/// Number of flights, which differ by the phases of their gusts.
const FLIGHTS: usize = 2;
/// Ticks between two whose strains are counted in the mean and in the 99.9 %.
const SAMPLED_EVERY: u32 = 4;

/// A flag of a metre on a pole in wind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Flag {
    /// Particles along each side.
    pub n: u32,
    /// Name of the material.
    pub material: &'static str,
    /// Area density, kg/m².
    pub density: f32,
    /// Stiffness of warp and weft, N/m.
    pub stiffness: f32,
    /// Mean wind, m/s.
    pub wind: f32,
}

/// How the substeps of a flight are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// The same in every tick.
    Fixed(StepSettings),
    /// By need, within the default limits.
    ByNeed,
}

/// Figures of a flag's flights.
#[derive(Clone, Debug, Serialize)]
pub struct Flights {
    /// Mean number of substeps in a tick.
    pub substeps: f64,
    /// Most substeps in a tick.
    pub most_substeps: u32,
    /// Passes in a substep.
    pub passes: u32,
    /// Mean strain of warp and weft, %.
    pub mean: f64,
    /// Strain that one link in a thousand exceeds, %.
    pub p999: f64,
    /// Greatest stretch of any link in any tick, %.
    pub greatest: f64,
    /// Mean position of the free upper corner, m.
    pub tip: [f64; 3],
    /// Root mean square speed, m/s.
    pub speed: f64,
    /// Time of a tick of a lone flag, µs.
    pub us: f64,
}

impl Flag {
    /// Flies for some seconds.
    #[must_use]
    pub fn fly(&self, substeps: Substeps, seconds: f64) -> Flights {
        let fabric = self.fabric();
        let mut sums = Sums::default();
        for flight in 0..FLIGHTS {
            self.fly_once(&fabric, substeps, seconds, flight, &mut sums);
        }
        sums.figures(substeps)
    }

    fn fabric(&self) -> Arc<Fabric> {
        let grid = FabricBuilder::grid(Grid::new(self.n, self.n, 1.0, 1.0));
        Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good grid"))
    }

    fn material(&self) -> FabricMaterial {
        FabricMaterial {
            area_density: self.density,
            warp_stiffness: self.stiffness,
            weft_stiffness: self.stiffness,
            ..FabricMaterial::FLAG_POLYESTER
        }
    }

    /// Wind at a time (s), m/s: the mean and a quarter of it in gusts.
    fn wind(&self, time: f32, flight: usize) -> Vec3 {
        let wave = |frequency: f32, phase: f32| {
            (core::f32::consts::TAU * frequency * time + 1.7 * flight as f32 * phase).sin()
        };
        self.wind
            * Vec3::new(
                1.0 + 0.15 * wave(0.31, 1.0) + 0.1 * wave(0.83, 2.3),
                0.1 * wave(0.57, 3.1),
                0.15 * wave(0.43, 1.9) + 0.1 * wave(1.1, 0.7),
            )
    }

    fn fly_once(
        &self,
        fabric: &Arc<Fabric>,
        substeps: Substeps,
        seconds: f64,
        flight: usize,
        sums: &mut Sums,
    ) {
        let material = self.material();
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        batch.insert(&almost_at_rest(fabric), material).expect("a good cloth");
        let mut need = Need::within(StepLimits::default());
        let mut positions = [fabric.rest_positions().to_vec(), Vec::new()];
        for tick in 0..ticks(SETTLING + seconds) {
            let wind = self.wind(tick as f32 * TICK, flight);
            let drive = Drive { wind, ..Drive::default() };
            batch.drive(0, drive).expect("a good drive");
            let settings = match substeps {
                Substeps::Fixed(settings) => settings,
                Substeps::ByNeed => need.settings(fabric, &drive, TICK),
            };
            let began = Instant::now();
            batch.step(TICK, settings);
            let time = began.elapsed().as_secs_f64();
            let [before, after] = &mut positions;
            batch.copy_positions(0, after);
            need.note(fabric, &material, &drive, [before, after], TICK);
            if tick >= ticks(SETTLING) {
                sums.add(fabric, &batch, after, settings, time);
            }
            positions.swap(0, 1);
        }
    }
}

/// At rest but for a tenth of a millimetre, as a perfect plane would not leave its plane.
fn almost_at_rest(fabric: &Fabric) -> ClothSnapshot {
    let mut state = ClothSnapshot::at_rest(fabric);
    for (particle, at) in state.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += 1e-4 * ((particle * 7919 % 1000) as f32 / 1000.0 - 0.5);
        }
    }
    state
}

/// Sums over ticks and flights.
#[derive(Default)]
struct Sums {
    ticks: u32,
    substeps: u32,
    most_substeps: u32,
    strains: Vec<f64>,
    greatest: f64,
    tip: glam::DVec3,
    squared_speed: f64,
    /// s.
    time: f64,
}

impl Sums {
    fn add(
        &mut self,
        fabric: &Fabric,
        batch: &ClothBatch,
        positions: &[Vec3],
        settings: StepSettings,
        time: f64,
    ) {
        self.ticks += 1;
        self.substeps += settings.substeps;
        self.most_substeps = self.most_substeps.max(settings.substeps);
        self.time += time;
        let links = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
        let is_sampled = self.ticks.is_multiple_of(SAMPLED_EVERY);
        for link in links {
            let [from, to] = link.particles.map(|particle| positions[particle as usize]);
            let strain = f64::from(from.distance(to) / link.rest_length) - 1.0;
            self.greatest = self.greatest.max(strain);
            if is_sampled {
                self.strains.push(strain);
            }
        }
        let columns = fabric.particle_count().isqrt();
        self.tip += positions[columns - 1].as_dvec3();
        let mut velocities = Vec::new();
        batch.copy_velocities(0, &mut velocities);
        let velocities: Vec<_> = velocities.iter().map(|velocity| velocity.as_dvec3()).collect();
        self.squared_speed += rms_length(&velocities).powi(2);
    }

    fn figures(self, substeps: Substeps) -> Flights {
        let ticks = f64::from(self.ticks);
        let strain = Strain::of(self.strains.into_iter());
        let passes = match substeps {
            Substeps::Fixed(settings) => settings.passes,
            Substeps::ByNeed => StepLimits::default().passes,
        };
        Flights {
            substeps: f64::from(self.substeps) / ticks,
            most_substeps: self.most_substeps,
            passes,
            mean: 100.0 * strain.mean,
            p999: 100.0 * strain.p999,
            greatest: 100.0 * self.greatest,
            tip: (self.tip / ticks).to_array(),
            speed: (self.squared_speed / ticks).sqrt(),
            us: 1e6 * self.time / ticks,
        }
    }
}
