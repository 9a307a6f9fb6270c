//! Flags against the converged reference and the levels of one flag against each other: figures of `docs/measurements.md`.

use bunting_solver::StepSettings;

use super::{
    case::HardCase,
    rig::{start, strain},
};
use crate::{
    flight::{self, Flag, Substeps},
    levels::{agreement::Agreement, pops::Pop, switches::Switch},
    product::DEFAULT,
    scenes::Scene,
    simulation::Simulation,
    stats::worse,
};

/// Particles along each side of flags, and of their levels.
const SIZES: [usize; 3] = [33, 17, 9];
/// Greatest strain of the converged flag in the scene `flag`, %: `bunting_lab pareto`.
const CONVERGED: f64 = 2.55;
/// Factor by which the greatest strain may exceed it.
const STRAIN: f64 = 1.5;
/// Substeps of a flag that is nearly converged.
const MANY: StepSettings = StepSettings { passes: 2, ..StepSettings::yarns(32) };
/// Mean winds, m/s.
const WINDS: [f32; 3] = [6.0, 12.0, 25.0];
/// Part of its speed that a flag may lack or have too much, %.
const SPEED: f64 = 6.0;
/// Length of a flight, s.
const SECONDS: f64 = 8.0;
/// Difference of a length or a frequency between levels that is not seen, %.
const AGREE: f64 = 5.0;
/// Part of the kinetic energy that a change of level may add.
const ENERGY: f64 = 0.01;
/// Largest pop that is not seen, px.
const POP: f64 = 1.0;
/// Moments at which levels change.
const MOMENTS: usize = 20;

/// Cases of the strain and the speed of flags.
pub fn flights(_quick: bool) -> Vec<HardCase> {
    let mut cases = vec![greatest_strain()];
    cases.extend(speeds());
    cases
}

/// Cases of the agreement of levels, and of changes between them.
pub fn levels(_quick: bool) -> Vec<HardCase> {
    let mut cases = agreement().to_vec();
    cases.extend([energy(), pop()]);
    cases
}

/// Case of the greatest strain of any link in any tick.
fn greatest_strain() -> HardCase {
    let scene = Scene::flag(SIZES[0]);
    let mut flag = start(&scene);
    let mut worst = 0.0;
    for tick in 0..scene.ticks() {
        flag.tick();
        if tick >= scene.window_start() {
            worst = worse(worst, 100.0 * strain(&scene, &flag).max);
        }
    }
    HardCase::new("flag: greatest strain", SIZES[0], "%", worst, STRAIN * CONVERGED)
}

/// Cases of the RMS speed by need against that with many substeps.
fn speeds() -> Vec<HardCase> {
    let flag = |wind| Flag {
        n: SIZES[0] as u32,
        material: "polyester",
        density: 0.113,
        stiffness: 2e3,
        wind,
    };
    let flags = WINDS.map(flag);
    let by_need = flight::fly(&flags, Substeps::ByNeed, SECONDS);
    let converged = flight::fly(&flags, Substeps::Fixed(MANY), SECONDS);
    let cases = WINDS.into_iter().zip(by_need).zip(converged).map(|((wind, flight), right)| {
        let error = 100.0 * (flight.speed / right.speed - 1.0).abs();
        let figure = "% off the RMS speed with 32 substeps";
        HardCase::new(format!("flag in {wind} m/s: speed"), SIZES[0], figure, error, SPEED)
    });
    cases.collect()
}

/// Cases of the greatest differences of coarser levels from the finest.
fn agreement() -> [HardCase; 3] {
    let levels = SIZES.map(|n| Agreement::of(n, DEFAULT, false));
    let case = |name: &str, figure: fn(&Agreement) -> f64| {
        let off = levels.iter().map(|level| (figure(level) / figure(&levels[0]) - 1.0).abs());
        let worst = 100.0 * off.fold(0.0, worse);
        HardCase::new(format!("levels: {name}"), SIZES[0], "% off the finest", worst, AGREE)
    };
    [
        case("droop", |level| level.droop_m),
        case("swing period", |level| level.swing_period_s),
        case("flutter frequency", |level| level.flutter_hz),
    ]
}

/// Both ways between neighbours among the levels.
fn changes() -> impl Iterator<Item = (usize, usize)> {
    SIZES.windows(2).flat_map(|pair| [(pair[0], pair[1]), (pair[1], pair[0])])
}

/// Case of the energy that a change of level adds to a flag.
fn energy() -> HardCase {
    let grown = changes().map(|(from, to)| Switch::of(from, to, DEFAULT, MOMENTS).energy_worst);
    let worst = grown.fold(0.0, worse);
    HardCase::new(
        "change of level: energy gained",
        SIZES[0],
        "of the kinetic energy",
        worst,
        ENERGY,
    )
}

/// Case of the greatest departure of any of eighty flags from its motion by a change to the finest level, which is seen
/// from the least distance.
fn pop() -> HardCase {
    let [fine, coarse, _] = SIZES;
    let worst = Pop::of(coarse, fine, DEFAULT, MOMENTS).worst_px;
    HardCase::new("change of level: worst pop of 80 flags", fine, "px at 10 m", worst, POP)
}
