//! Sweeps over sizes, passes, rates and step lengths.

use bunting_solver::{StepLimits, StepSettings};

use super::{
    case::HardCase,
    rig::{energy, speed, start, start_within, strain},
};
use crate::{
    oracles::{rig::strip, trials},
    product::{Cloth, DEFAULT, Product},
    reference::grid::Grid,
    scenes::{Fabric, Pins, Pose, Scene, ticks},
    simulation::{Simulation, in_double, run},
    specimen::Specimen,
    stats::{crossing_frequency, rms_distance, worse},
};

/// Largest difference of mean strains, percentage points.
const STRAIN: f64 = 0.2;
/// Largest relative difference of periods.
const PERIOD: f64 = 0.01;
/// Largest rise of the energy above its start, over the energy of the sheet's fall.
const ENERGY: f64 = 0.01;
/// Time in which a cloth damped by 2/s comes to rest, s: its motion has decayed to e⁻¹².
const SETTLING: f64 = 12.0;
/// Time in which the folds of a limp flag fall into place, s: some of 65 × 65 still move at 35 mm/s after 12 s, with
/// eight and with sixteen substeps as well, and none after 20 s.
const FOLDING: f64 = 30.0;
/// Greatest speed of cloth at rest, m/s RMS.
const REST_SPEED: f64 = 1e-3;
/// Largest 95th percentile of strain at rest, %.
const REST_STRAIN: f64 = 1.0;

/// All sweeps.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let sizes: &[usize] = if quick { &[9, 17] } else { &[9, 17, 33, 65] };
    let mut cases = vec![resolution(sizes), passes_and_rates_strain(), passes_and_rates_period()];
    for &n in if quick { &[17][..] } else { &[17, 33, 65] } {
        cases.extend([1, 2, 4].map(|substeps| whip(n, substeps)));
    }
    for &n in sizes {
        cases.extend(rest("two-corner pin", Scene::hang_corners(n), SETTLING));
        cases.extend(rest("one-side pin", Scene::hang_side(n), FOLDING));
    }
    let ripples: &[usize] = if quick { &[17] } else { &[17, 33, 65] };
    cases.extend(ripples.iter().map(|&n| rest_of_other_ripples(n)));
    cases.extend(tiny_steps(if quick { 9 } else { 17 }));
    cases.push(resting(quick));
    cases.push(stiff_bending());
    cases.extend([1.0, 2.0].map(nudged_strip));
    cases
}

fn resolution(sizes: &[usize]) -> HardCase {
    let strains: Vec<f64> = sizes
        .iter()
        .map(|&n| {
            let scene = Scene::hang_top(n);
            let mut cloth = start(&scene);
            run(&mut cloth, scene.seconds);
            100.0 * strain(&scene, &cloth).mean
        })
        .collect();
    HardCase::new(
        "resolution sweep",
        0,
        "difference of mean strain, points",
        spread(&strains),
        STRAIN,
    )
}

/// Lengths of ticks in seconds at a rate in hertz; a rate of zero jitters by half about 60 Hz.
fn tick_lengths(rate: u32) -> impl Iterator<Item = f32> {
    let mean = if rate == 0 { 60.0 } else { rate as f32 };
    (0..).map(move |k: u32| {
        let jitter = if rate == 0 { (k as f32 * 2.4).sin() * 0.5 } else { 0.0 };
        (1.0 + jitter) / mean
    })
}

/// Settings of the sweep: numbers of passes at 60 Hz, then rates with default settings.
fn sweep() -> impl Iterator<Item = (StepSettings, u32)> {
    let passes = [1, 2, 4, 8].map(|passes| (StepSettings { passes, ..DEFAULT }, 60));
    let rates = [30, 144, 240, 0].map(|rate| (DEFAULT, rate));
    passes.into_iter().chain(rates)
}

fn passes_and_rates_strain() -> HardCase {
    let scene = Scene::hang_top(17);
    let strains: Vec<f64> = sweep()
        .map(|(settings, rate)| {
            let mut cloth = Product::lone(settings).start(&scene);
            follow(&mut cloth, rate, scene.seconds, |_, _| ());
            100.0 * strain(&scene, &cloth).mean
        })
        .collect();
    let worst = spread(&strains);
    HardCase::new("passes 1–8, 30–240 Hz, jitter: strain", 17, "difference, points", worst, STRAIN)
}

fn passes_and_rates_period() -> HardCase {
    let fabric = Fabric { bending: 100.0, ..Fabric::STANDARD };
    let scene = strip(8, 1.0, Pins::Top, Pose::Vertical, fabric);
    let tilted: Vec<_> =
        scene.positions().iter().map(|x| glam::dvec3(x.x, x.y, -0.05 * x.y)).collect();
    let still = vec![glam::DVec3::ZERO; tilted.len()];
    let periods: Vec<f64> = sweep()
        .map(|(settings, rate)| {
            let mut cloth = Product::lone(settings).start(&scene);
            cloth.place(&tilted, &still);
            period(&mut cloth, rate)
        })
        .collect();
    let worst = spread(&periods) / periods[0];
    HardCase::new("passes 1–8, 30–240 Hz, jitter: period", 8, "difference, of one", worst, PERIOD)
}

/// Period in seconds of a pendulum, from its tip, resampled at equal intervals.
fn period(cloth: &mut Cloth, rate: u32) -> f64 {
    const SAMPLE: f64 = 1.0 / 240.0;
    let (mut samples, mut last) = (Vec::new(), None);
    follow(cloth, rate, 8.0, |cloth, time| {
        let tip = f64::from(cloth.positions()[cloth.positions().len() - 1].z);
        if let Some((before, was)) = last {
            while (samples.len() as f64) * SAMPLE <= time {
                let part = (samples.len() as f64 * SAMPLE - before) / (time - before);
                samples.push(was + (tip - was) * part);
            }
        }
        last = Some((time, tip));
    });
    crossing_frequency(&samples, 1.0 / SAMPLE).map_or(f64::NAN, f64::recip)
}

/// Runs for `seconds` s at a rate, and calls `see` with the cloth and the time after each tick.
fn follow(cloth: &mut Cloth, rate: u32, seconds: f64, mut see: impl FnMut(&Cloth, f64)) {
    let mut time = 0.0;
    for tick in tick_lengths(rate) {
        if time >= seconds {
            break;
        }
        cloth.advance(tick);
        time += f64::from(tick);
        see(cloth, time);
    }
}

fn whip(n: usize, substeps: u32) -> HardCase {
    let scene = Scene::swing(n);
    let grid = Grid::new(&scene);
    let limits = StepLimits { substeps: substeps..=16, rate: 0, ..StepLimits::default() };
    let mut cloth = start_within(&scene, limits);
    let worst = (0..ticks(3.0)).fold(0.0, |worst, _| {
        cloth.tick();
        worse(worst, energy(&scene, &grid, &cloth))
    });
    let name = format!("90° whip, at least {substeps} substeps");
    HardCase::new(name, n, "energy over the start, of the fall", worst, ENERGY)
}

fn rest(name: &str, scene: Scene, seconds: f64) -> [HardCase; 2] {
    let mut cloth = start(&scene);
    run(&mut cloth, seconds);
    let n = scene.columns;
    let stretched = 100.0 * strain(&scene, &cloth).p95;
    [
        HardCase::new(format!("{name}: at rest"), n, "RMS speed, m/s", speed(&cloth), REST_SPEED),
        HardCase::new(format!("{name}: strain"), n, "95th percentile, %", stretched, REST_STRAIN),
    ]
}

/// Case of the greatest speed at rest of sheets that hang from their sides and started with different ripples.
fn rest_of_other_ripples(n: usize) -> HardCase {
    const HEIGHTS: [f64; 5] = [2e-4, 5e-4, 2e-3, 5e-3, 1e-2];
    let speeds = HEIGHTS.map(|height| {
        let scene = Scene { pose: Pose::Rippled(height), ..Scene::hang_side(n) };
        let mut cloth = start(&scene);
        run(&mut cloth, FOLDING);
        speed(&cloth)
    });
    let worst = speeds.into_iter().fold(0.0, worse);
    let name = format!("one-side pin: at rest, {} starts", HEIGHTS.len());
    HardCase::new(name, n, "RMS speed, m/s", worst, REST_SPEED)
}

fn tiny_steps(n: usize) -> [HardCase; 2] {
    const WINDOW: usize = 60;
    let scene = Scene::hang_top(n);
    let settled = |substeps| {
        let mut cloth = Product::lone(StepSettings::yarns(substeps)).start(&scene);
        run(&mut cloth, SETTLING);
        cloth
    };
    let (coarse, mut fine) = (settled(8), settled(64));
    let shape = rms_distance(&in_double(coarse.positions()), &in_double(fine.positions()));
    let seen: Vec<_> = (0..WINDOW)
        .map(|_| {
            fine.tick();
            in_double(fine.positions())
        })
        .collect();
    let mean: Vec<_> = (0..scene.vertices())
        .map(|vertex| seen.iter().map(|x| x[vertex]).sum::<glam::DVec3>() / WINDOW as f64)
        .collect();
    let jitter = seen.iter().map(|x| rms_distance(x, &mean)).fold(0.0, worse);
    [
        HardCase::new("64 substeps: jitter", n, "RMS, m", jitter, 1e-4),
        HardCase::new("64 substeps: shape of 8", n, "RMS distance, m", shape, 1e-3),
    ]
}

fn resting(quick: bool) -> HardCase {
    let scene = Scene::hang_top(17);
    let mut cloth = start(&scene);
    run(&mut cloth, 10.0);
    let settled = in_double(cloth.positions());
    run(&mut cloth, if quick { 20.0 } else { 600.0 });
    let drift = rms_distance(&settled, &in_double(cloth.positions()));
    HardCase::new("rest: 10 min hanging", 17, "drift, m", drift, 1e-4)
}

fn stiff_bending() -> HardCase {
    let aspect = trials::stiffest_cantilever(&|scene, settings| {
        Box::new(Product::lone(settings).start(scene))
    });
    HardCase::new("stiff bending, Γ = 0.01", 32, "error of H/W = Γ/8, of one", aspect, 0.02)
}

/// Case of a stiff clamped strip without load, displaced in its plane, which must oscillate about its rest
/// shape. Its cells are `aspect` times as wide as long.
fn nudged_strip(aspect: f64) -> HardCase {
    const SEGMENTS: usize = 32;
    const NUDGE: f64 = 1e-4;
    let fabric = Fabric { bending: 0.025, ..Fabric::STANDARD };
    let strip = strip(SEGMENTS, 1.0, Pins::TopClamp, Pose::Vertical, fabric);
    let scene = Scene { width: aspect / SEGMENTS as f64, gravity: 0.0, ..strip };
    let start_at = scene.positions();
    let nudged: Vec<_> =
        start_at.iter().map(|x| *x + glam::DVec3::X * (NUDGE * x.y * x.y)).collect();
    let mut cloth = start(&scene);
    cloth.place(&nudged, &vec![glam::DVec3::ZERO; nudged.len()]);
    let worst = (0..ticks(20.0)).fold(0.0, |worst, _| {
        cloth.tick();
        let moved = in_double(cloth.positions());
        let off = moved.iter().zip(&start_at).map(|(x, at)| x.distance(*at));
        worse(worst, off.fold(0.0, worse) / NUDGE)
    });
    let name = format!("stiff strip nudged in its plane, cells {aspect} : 1");
    HardCase::new(name, SEGMENTS, "farthest, over the nudge", worst, 1.5)
}

/// Difference between the largest and the smallest value.
fn spread(values: &[f64]) -> f64 {
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    if values.iter().any(|value| value.is_nan()) { f64::NAN } else { high - low }
}
