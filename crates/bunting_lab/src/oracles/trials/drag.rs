//! A sheet that falls or flies broadside through still air.

use bunting_solver::StepSettings;
use glam::DVec3;

use crate::{
    oracles::{
        Case,
        drag::BroadsideFall,
        rig::{Substeps, YARNS, label, order, substep},
    },
    scenes::{Air, Fabric, GRAVITY, Pins, Scene, ticks},
    simulation::run,
    specimen::{Mount, Specimen},
};

/// σ = 0.1 kg/m², C_d = 1.2, ρ = 1.225 kg/m³.
const FALL: BroadsideFall = BroadsideFall { gravity: GRAVITY, density: 0.1, drag: 1.2 * 1.225 };
/// Speed at which a step of 7 ms of explicit drag reverses the motion, m/s.
const FAST: f64 = 20.0;
/// Time for which the fast sheet is dragged, s.
const DRAGGED: f64 = 0.1;
/// Relative error of an update whose result for drag alone is known: rounding in single precision.
const EXACT: f64 = 1e-4;
/// Gauss–Seidel with few substeps, which suffice for air alone.
const GAUSS_SEIDEL: StepSettings = StepSettings::gauss_seidel(10);

/// Cases of a fall from rest, and of drag alone.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for settings in [YARNS, GAUSS_SEIDEL] {
        let fall = |seconds: f64| {
            let mut specimen = start(mount, GRAVITY, 0.0, settings);
            run(specimen.as_mut(), seconds);
            specimen
        };
        // Gravity and drag applied in turn are of first order: the terminal speed is too high by gh/2v_t, and
        // a fall from rest is off by up to twice as much.
        let tolerance = GRAVITY * substep(settings) / FALL.terminal_speed();
        let label = label(settings);
        cases.push(Case::new(
            format!("broadside fall v(0.1), N = 4, {label}, m/s"),
            FALL.speed(0.1),
            -mean(fall(0.1).velocities()).y,
            tolerance,
        ));
        for seconds in [0.5, 1.0] {
            cases.push(Case::new(
                format!("broadside fall y({seconds}), N = 4, {label}, m"),
                FALL.depth(seconds),
                -mean(fall(seconds).positions()).y,
                tolerance,
            ));
        }
    }
    cases.push(Case::new(
        format!("drag alone from {FAST} m/s, N = 4, {}, m/s", label(YARNS)),
        FALL.dragged(FAST, DRAGGED),
        dragged(mount, YARNS),
        EXACT,
    ));
    // Gauss–Seidel ends 4 % slower than exact, which is expected of its form of the drag.
    let h = substep(GAUSS_SEIDEL);
    let steps = (DRAGGED / h).round() as usize;
    cases.push(Case::new(
        format!(
            "drag alone from {FAST} m/s, N = 4, {}, as its form predicts, m/s",
            label(GAUSS_SEIDEL)
        ),
        FALL.dragged_in_steps(FAST, h, steps),
        dragged(mount, GAUSS_SEIDEL),
        EXACT,
    ));
    for settings in [YARNS, StepSettings::yarns(1), StepSettings::gauss_seidel(1)] {
        let name =
            format!("drag alone from {FAST} m/s, ticks not turned round, {}", label(settings));
        cases.push(Case::new(name, 1.0, onward(mount, settings), 0.0));
    }
    // Backward Euler treats the air to first order; the multistep formula to second order.
    for (scheme, expected) in
        [(StepSettings::yarns as Substeps, 2.0), (StepSettings::gauss_seidel, 1.0)]
    {
        let errors = [2, 4, 8].map(|substeps| {
            let mut specimen = start(mount, GRAVITY, 0.0, scheme(substeps));
            run(specimen.as_mut(), 1.0);
            -mean(specimen.positions()).y - FALL.depth(1.0)
        });
        let name = format!("broadside fall y(1), order in the step, {}", label(scheme(8)));
        cases.push(order(name, expected, &errors));
    }
    cases
}

/// Final speed of the fast sheet, m/s.
fn dragged(mount: &Mount, settings: StepSettings) -> f64 {
    let mut specimen = start(mount, 0.0, FAST, settings);
    run(specimen.as_mut(), DRAGGED);
    mean(specimen.velocities()).y
}

/// Fraction of the ticks after which the fast sheet still moves in its first direction. Explicit drag
/// reverses the motion in steps longer than 2σ/(ρ C_d v), 6.8 ms, and diverges in steps of more than twice
/// that.
fn onward(mount: &Mount, settings: StepSettings) -> f64 {
    let mut specimen = start(mount, 0.0, FAST, settings);
    let ticks = ticks(DRAGGED);
    let onward = (0..ticks).filter(|_| {
        specimen.tick();
        mean(specimen.velocities()).y > 0.0
    });
    onward.count() as f64 / ticks as f64
}

/// A free level sheet that rises at `speed` m/s.
fn start(mount: &Mount, gravity: f64, speed: f64, settings: StepSettings) -> Box<dyn Specimen> {
    let scene = Scene {
        fabric: Fabric { density: FALL.density, ..Fabric::STANDARD },
        air: Air { pressure: FALL.drag, ..Air::VACUUM },
        pins: Pins::Free,
        gravity,
        ..Scene::swing(5)
    };
    let mut specimen = mount(&scene, settings);
    specimen.place(&scene.positions(), &vec![DVec3::Y * speed; scene.vertices()]);
    specimen
}

fn mean(vectors: &[glam::Vec3]) -> DVec3 {
    vectors.iter().map(|v| v.as_dvec3()).sum::<DVec3>() / vectors.len() as f64
}
