//! Flags in storms and on fast vehicles: how far their warp and weft are stretched.

use std::f32::consts::TAU;

use bunting_solver::FrameMotion;
use glam::{Quat, Vec3};

use super::{
    case::HardCase,
    rig::{energy, start},
};
use crate::{
    flight::almost_at_rest,
    product::{Cloth, TICK},
    reference::grid::Grid,
    scenes::{Air, Fabric, Scene, ticks},
    simulation::{Simulation, in_double},
    stats::worse,
};

/// Density of the air times the coefficients of pressure and friction of polyester flags, kg/m³.
const AIR: [f64; 2] = [1.47, 0.0245];
/// Area densities of light and usual flags, kg/m².
const LIGHT: f64 = 0.03;
const USUAL: f64 = 0.113;
/// Area density (kg/m²) and stiffness (N/m) of a banner. One of 2 kN/m would be stretched by 30 % by its own inertia at
/// the 395 m/s² of a pole shaken by a tenth of a metre at 10 Hz.
const HEAVY: f64 = 1.5;
const STIFF: f64 = 2e4;
/// Fabric of the flags.
const FABRIC: Fabric = Fabric { density: USUAL, stretch: [2000.0; 2], shear: 19.0, bending: 1e-5 };
/// Greatest strain in a storm, %.
const STORM: f64 = 12.0;
/// Greatest strain after a jerk, %.
const JERK: f64 = 40.0;
/// Greatest strain after a tick of half a second, %.
const HITCH: f64 = 60.0;
/// Time after which a jerk has passed, s.
const PASSED: f64 = 0.3;

/// Greatest departure from the extrapolated motion by a change of effort, beyond the cloth's own, px. Larger: a change is
/// seen.
const SEEN: f64 = 0.5;
/// Pixels of a metre at a distance of 10 m, with 1,080 lines over 60°.
const PIXELS: f64 = 93.5;
/// Ticks between two changes of effort whose shift is measured.
const CHANGED_EVERY: usize = 10;

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let sizes: &[usize] = if quick { &[17] } else { &[17, 33, 65] };
    let seconds = if quick { 3.0 } else { 10.0 };
    sizes.iter().flat_map(|&n| of_size(n, seconds)).collect()
}

fn of_size(n: usize, seconds: f64) -> Vec<HardCase> {
    let mut cases = Vec::new();
    for density in [LIGHT, USUAL] {
        let name = format!("storm of 25 m/s on {density} kg/m²");
        let mut flag = Flag::new(n, density, 25.0);
        cases.push(flag.case(name, STORM, |flag| flag.fly(seconds)));
    }
    cases.extend(stopped(n));
    cases.extend(hitch(n));
    cases.push(Flag::new(n, USUAL, 5.0).case(
        "vehicle from 25 m/s to rest and back",
        JERK,
        |flag| {
            let speed = |time: f32| if (1.0..2.0).contains(&time) { 0.0 } else { 25.0 };
            flag.ride(3.0, |time| Vec3::X * -speed(time), 0.0);
        },
    ));
    cases.push(Flag::new(n, USUAL, 0.0).case("spin-up to 20 rad/s in 1 s", STORM, |flag| {
        flag.ride(3.0, |_| Vec3::ZERO, 20.0);
    }));
    cases.push(Flag::new(n, LIGHT, 0.0).case("wind of 15 m/s turned in 0.1 s", STORM, |flag| {
        flag.blow(4.0, |time| 15.0 * (1.0 - 2.0 * ((time - 2.0) / 0.1).clamp(0.0, 1.0)));
    }));
    cases.push(Flag::new(n, USUAL, 0.0).case("wind of ±25 m/s at 5 Hz", STORM, |flag| {
        flag.blow(4.0, |time| 25.0 * (5.0 * f64::from(TAU) * time).sin());
    }));
    let banner = Fabric { density: HEAVY, stretch: [STIFF; 2], ..FABRIC };
    cases.push(Flag::of(banner, n, 0.0).case(
        "1.5 kg/m² shaken by ±0.1 m at 10 Hz",
        JERK,
        |flag| {
            let rate = 10.0 * TAU;
            flag.ride(3.0, |time| Vec3::X * (0.1 * rate * (rate * time).cos()), 0.0);
        },
    ));
    cases.push(Flag::new(n, USUAL, 10.0).case("ticks of 1/20 to 1/1000 s", STORM, |flag| {
        for tick in 0..600 {
            flag.advance([20.0, 60.0, 144.0, 1000.0][(tick / 3 + tick / 7) % 4]);
        }
    }));
    cases.push(changed(n));
    cases.extend(
        [("by a class", 1.5), ("twofold", 2.0)]
            .into_iter()
            .flat_map(|(change, ratio)| seen(n, change, ratio)),
    );
    cases
}

/// A flag of a metre that is watched in every tick.
struct Flag {
    scene: Scene,
    grid: Grid,
    cloth: Cloth,
    /// Greatest strain of warp and weft so far, %.
    worst: f64,
}

impl Flag {
    fn new(n: usize, density: f64, wind: f64) -> Self {
        Self::of(Fabric { density, ..FABRIC }, n, wind)
    }

    /// A flag at rest but for a tenth of a millimetre: a plane one would fold within its plane where nothing moves it
    /// out.
    fn of(fabric: Fabric, n: usize, wind: f64) -> Self {
        let flag = Scene::flag(n);
        let scene = Scene {
            fabric,
            air: Air {
                wind: [wind, 0.0, 0.0],
                gust: [0.2 * wind, 0.1 * wind, 0.2 * wind],
                gust_rate: 5.0,
                pressure: AIR[0],
                friction: AIR[1],
            },
            ..flag
        };
        let mut cloth = start(&scene);
        cloth.restore(&almost_at_rest(cloth.batch.fabric()));
        Self { grid: Grid::new(&scene), cloth, scene, worst: 0.0 }
    }

    fn case(&mut self, name: impl Into<String>, limit: f64, fly: impl Fn(&mut Self)) -> HardCase {
        fly(self);
        HardCase::new(name, self.scene.columns, "greatest strain, %", self.worst, limit)
    }

    /// Greatest strain of warp and weft, %.
    fn strain(&self) -> f64 {
        let positions = in_double(self.cloth.positions());
        100.0 * self.grid.strains(&positions).fold(0.0, worse)
    }

    /// Advances by a tick at a rate (1/s).
    fn advance(&mut self, rate: f32) {
        self.cloth.advance(1.0 / rate);
        self.worst = worse(self.worst, self.strain());
    }

    fn fly(&mut self, seconds: f64) {
        (0..ticks(seconds)).for_each(|_| self.advance(1.0 / TICK));
    }

    /// Flies in a wind along x, m/s.
    fn blow(&mut self, seconds: f64, wind: impl Fn(f64) -> f64) {
        for tick in 0..ticks(seconds) {
            let wind = wind(tick as f64 * f64::from(TICK));
            self.cloth.change(|scene| scene.air.wind = [wind, 0.0, 0.0]);
            self.advance(1.0 / TICK);
        }
    }

    /// Rides on a frame that has a velocity (m/s), and is brought to a turn about its pole (rad/s) in a second.
    fn ride(&mut self, seconds: f64, velocity: impl Fn(f32) -> Vec3, turn: f32) {
        let gravity = self.cloth.drive.gravity;
        for tick in 0..ticks(seconds) {
            let time = tick as f32 * TICK;
            let rotation = Quat::from_rotation_y(turn * time.min(1.0) * TICK);
            let translation = velocity(time) * TICK;
            self.cloth.drive.motion = FrameMotion { rotation, translation };
            self.advance(1.0 / TICK);
        }
        self.cloth.drive.gravity = gravity;
    }

    /// Greatest strain in the next ticks, %: until the jerk has passed, and in the second after.
    fn strains_after(&mut self) -> [f64; 2] {
        [PASSED, 1.0].map(|seconds| {
            self.worst = 0.0;
            self.fly(seconds);
            self.worst
        })
    }
}

/// Cases of a pole that is stopped from 20 m/s within a tick.
fn stopped(n: usize) -> [HardCase; 2] {
    let mut flag = Flag::new(n, USUAL, 0.0);
    flag.ride(3.0, |_| Vec3::X * -20.0, 0.0);
    flag.cloth.drive.motion = FrameMotion::NONE;
    let [jerked, after] = flag.strains_after();
    [
        HardCase::new("pole stopped from 20 m/s", n, "greatest strain, %", jerked, JERK),
        HardCase::new(
            "pole stopped from 20 m/s: after 0.3 s",
            n,
            "greatest strain, %",
            after,
            STORM,
        ),
    ]
}

/// Cases of a flag in 6 m/s after a tick of half a second.
fn hitch(n: usize) -> [HardCase; 2] {
    let mut flag = Flag::new(n, USUAL, 6.0);
    flag.fly(2.0);
    flag.cloth.advance(0.5);
    let [jerked, after] = flag.strains_after();
    [
        HardCase::new("after a tick of 0.5 s", n, "greatest strain, %", jerked, HITCH),
        HardCase::new("after a tick of 0.5 s: after 0.3 s", n, "greatest strain, %", after, STORM),
    ]
}

/// Case of the energy that a sheet, swinging without damping, gains in a tick when its number of substeps changes.
fn changed(n: usize) -> HardCase {
    let scene = Scene::swing(n);
    let grid = Grid::new(&scene);
    let mut cloth = start(&scene);
    cloth.need = None;
    let mut worst = 0.0_f64;
    let mut last = energy(&scene, &grid, &cloth);
    for tick in 0..ticks(0.6) {
        cloth.settings.substeps = [2, 3, 8, 4, 2, 16][tick / 3 % 6];
        cloth.tick();
        let now = energy(&scene, &grid, &cloth);
        worst = worse(worst, 100.0 * (now - last));
        last = now;
    }
    HardCase::new("change of effort: energy gained", n, "of the fall in a tick, %", worst, 0.5)
}

/// Cases of how far a flag in 10 m/s departs from its extrapolated motion in a tick whose effort changes, to `ratio` times
/// the usual substeps or back: beyond the same tick without a change, and beyond the same tick of a flag that had the new
/// effort before. The first is the difference of two resolutions, which every later tick has, too; the second is what the
/// change itself does.
fn seen(n: usize, change: &str, ratio: f32) -> [HardCase; 2] {
    let mut flag = Flag::new(n, USUAL, 10.0);
    flag.fly(1.0);
    flag.cloth.need = None;
    let usual = flag.cloth.settings.substeps;
    let more = (ratio * usual as f32) as u32;
    let mut worst = [0.0_f64; 2];
    for [before, after] in [[usual, more], [more, usual]] {
        flag.cloth.settings.substeps = before;
        for _ in 0..ticks(2.0) / CHANGED_EVERY {
            (1..CHANGED_EVERY).for_each(|_| flag.cloth.tick());
            let earlier = flag.cloth.clone();
            flag.cloth.tick();
            let last = flag.cloth.clone();
            let mut changed = last.clone();
            changed.settings.substeps = after;
            let mut accustomed = accustomed(&earlier, &last, after);
            flag.cloth.tick();
            changed.tick();
            accustomed.tick();
            let departs =
                |cloth: &Cloth| departure(earlier.positions(), last.positions(), cloth.positions());
            for (worst, without) in worst.iter_mut().zip([&flag.cloth, &accustomed]) {
                *worst = worse(*worst, PIXELS * (departs(&changed) - departs(without)));
            }
        }
    }
    let case = |beyond: &str, worst: f64| {
        let name = format!("change of effort {change}: departure beyond {beyond}");
        HardCase::new(name, n, "px at 10 m", worst, SEEN)
    };
    [case("its own", worst[0]), case("that without a change of history", worst[1])]
}

/// The cloth `last` as if it had had other substeps in the tick after `earlier`: with its positions and velocities, and the
/// changes of velocity of a cloth that had.
fn accustomed(earlier: &Cloth, last: &Cloth, substeps: u32) -> Cloth {
    let mut other = earlier.clone();
    other.settings.substeps = substeps;
    other.tick();
    let mut state = other.batch.snapshot(0);
    let known = last.batch.snapshot(0);
    for (particle, velocity) in known.velocities.iter().enumerate() {
        state.add_velocity(particle, *velocity - state.velocities[particle]);
    }
    state.positions = known.positions;
    let mut accustomed = last.clone();
    accustomed.restore(&state);
    accustomed.settings.substeps = substeps;
    accustomed
}

/// Greatest distance of any particle from the position extrapolated linearly from two ticks, m.
fn departure(earlier: &[Vec3], last: &[Vec3], now: &[Vec3]) -> f64 {
    let triples = earlier.iter().zip(last).zip(now);
    let distances =
        triples.map(|((earlier, last), now)| f64::from(now.distance(2.0 * *last - *earlier)));
    distances.fold(0.0, worse)
}
