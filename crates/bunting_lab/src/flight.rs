//! Flags in gusty wind: strain, mean place and speed, and what they cost, with fixed substeps and by need.

use std::{
    hash::{DefaultHasher, Hash, Hasher},
    sync::Arc,
};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    LinkFamily, StepLimits, StepSettings,
};
use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{
    golden::StateHash,
    need::Need,
    product::TICK,
    reference::cache::cached,
    scenes::ticks,
    stats::{Strain, rms_length},
    timing::Timing,
};

/// Time before anything is measured, s.
const SETTLING: f64 = 2.0;
/// Number of flights, which differ by the phases of their gusts.
const FLIGHTS: usize = 2;
/// Ticks between two whose strains are counted in the mean and in the 99.9 %.
const SAMPLED_EVERY: u32 = 4;
/// Ticks of the flight by which editions of the solver are told apart.
const FINGERPRINT: usize = 60;
/// Ticks before a tick is timed, and ticks that are timed.
const TIMED: [usize; 2] = [30, 60];

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
#[derive(Clone, Debug, Serialize, Deserialize)]
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
}

/// Flies flags of one size for some seconds, several times each: side by side where their substeps are fixed.
#[must_use]
pub fn fly(flags: &[Flag], substeps: Substeps, seconds: f64) -> Vec<Flights> {
    let Some(fabric) = flags.first().map(Flag::fabric) else { return Vec::new() };
    let flights: Vec<Flight> = flags
        .iter()
        .enumerate()
        .flat_map(|(index, flag)| (0..FLIGHTS).map(move |number| Flight { flag, index, number }))
        .collect();
    let together = match substeps {
        Substeps::Fixed(_) => LaneCount::widest().get(),
        Substeps::ByNeed => 1,
    };
    let mut sums: Vec<Sums> = flags.iter().map(|_| Sums::default()).collect();
    for lanes in flights.chunks(together) {
        fly_together(&fabric, lanes, substeps, seconds, &mut sums);
    }
    sums.into_iter().map(|sums| sums.figures(substeps)).collect()
}

/// The same with fixed substeps, from the cache if this edition of the solver has flown these flags before.
#[must_use]
pub fn fly_or_recall(flags: &[Flag], settings: StepSettings, seconds: f64) -> Vec<Flights> {
    let key = (fingerprint(), flags, settings.substeps, settings.passes, seconds);
    cached(&key, || fly(flags, Substeps::Fixed(settings), seconds))
}

/// Numbers that differ between editions whose figures differ: a hash of this file, and one of the states of a short
/// flight.
fn fingerprint() -> [u64; 2] {
    let mut source = DefaultHasher::new();
    include_str!("flight.rs").hash(&mut source);
    let flag = Flag { n: 17, material: "", density: 0.03, stiffness: 2e4, wind: 25.0 };
    let mut batch = flag.batch();
    let mut hash = StateHash::new();
    let mut positions = Vec::new();
    for tick in 0..FINGERPRINT {
        batch.drive(0, flag.drive(tick, 0)).expect("a good drive");
        batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(4) });
        batch.copy_positions(0, &mut positions);
        hash.add(&positions);
    }
    [source.finish(), hash.value()]
}

/// Shortest time of a tick of a lone flag of n × n in a light wind, µs.
#[must_use]
pub fn time_of_tick(n: u32, settings: StepSettings) -> f64 {
    let flag = Flag { n, material: "", density: 0.113, stiffness: 2e3, wind: 6.0 };
    let mut batch = flag.batch();
    batch.drive(0, flag.drive(0, 0)).expect("a good drive");
    Timing::repeat(TIMED[0], TIMED[1], || batch.step(TICK, settings)).min()
}

/// One flight of a flag.
struct Flight<'a> {
    flag: &'a Flag,
    /// Index of the flag.
    index: usize,
    number: usize,
}

/// Flies side by side, and adds what is measured to the sums of each flag.
fn fly_together(
    fabric: &Arc<Fabric>,
    flights: &[Flight],
    substeps: Substeps,
    seconds: f64,
    sums: &mut [Sums],
) {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::holding(flights.len()));
    for flight in flights {
        batch.insert(&almost_at_rest(fabric), flight.flag.material()).expect("a good cloth");
    }
    let mut need = Need::within(StepLimits::default());
    let mut positions = [fabric.rest_positions().to_vec(), Vec::new()];
    for tick in 0..ticks(SETTLING + seconds) {
        for (lane, Flight { flag, number, .. }) in flights.iter().enumerate() {
            batch.drive(lane, flag.drive(tick, *number)).expect("a good drive");
        }
        let first = flights[0].flag.drive(tick, flights[0].number);
        let settings = match substeps {
            Substeps::Fixed(settings) => settings,
            Substeps::ByNeed => need.settings(fabric, &first, TICK),
        };
        batch.step(TICK, settings);
        if substeps == Substeps::ByNeed {
            let [before, after] = &mut positions;
            batch.copy_positions(0, after);
            need.note(&batch, &flights[0].flag.material(), &first, [before, after], TICK);
            positions.swap(0, 1);
        }
        if tick >= ticks(SETTLING) {
            for (lane, flight) in flights.iter().enumerate() {
                sums[flight.index].add(fabric, &batch, lane, settings);
            }
        }
    }
}

impl Flag {
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

    /// A batch of this flag alone.
    fn batch(&self) -> ClothBatch {
        let fabric = self.fabric();
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&almost_at_rest(&fabric), self.material()).expect("a good cloth");
        batch
    }

    /// Gravity and wind in a tick of a flight.
    fn drive(&self, tick: usize, flight: usize) -> Drive {
        Drive { wind: self.wind(tick as f32 * TICK, flight), ..Drive::default() }
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
}

/// At rest but for a tenth of a millimetre, as a perfect plane would not leave its plane.
pub(crate) fn almost_at_rest(fabric: &Fabric) -> ClothSnapshot {
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
}

impl Sums {
    fn add(&mut self, fabric: &Fabric, batch: &ClothBatch, lane: usize, settings: StepSettings) {
        let mut positions = Vec::new();
        batch.copy_positions(lane, &mut positions);
        self.ticks += 1;
        self.substeps += settings.substeps;
        self.most_substeps = self.most_substeps.max(settings.substeps);
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
        batch.copy_velocities(lane, &mut velocities);
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
        }
    }
}
