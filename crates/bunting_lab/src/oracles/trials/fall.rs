//! Free fall from rest.

use bunting_solver::StepSettings;

use crate::{
    oracles::{
        Case, free_fall,
        rig::{Substeps, label, order, substep},
    },
    scenes::{GRAVITY, Pins, Scene, ticks},
    simulation::run,
    specimen::Mount,
};

/// Length of the fall, s.
const SECONDS: f64 = 0.5;
/// Each of up to 600 additions rounds at most half a unit in the last place of 1.2 m, 6e-8 m.
const ROUNDING: f64 = 3e-5;

/// Height in metres after a number of steps, by gravity and step.
type Sum = fn(f64, f64, u32) -> f64;

/// Cases of the fall that each integrator sums, and of the order at which it approaches ½gt².
pub fn cases(mount: &Mount) -> Vec<Case> {
    let schemes: [(Substeps, Sum, f64); 2] = [
        (StepSettings::yarns, free_fall::bdf2_opt, 2.0),
        (StepSettings::gauss_seidel, free_fall::symplectic_euler, 1.0),
    ];
    let mut cases = Vec::new();
    for (scheme, sum, expected_order) in schemes {
        let mut errors = Vec::new();
        for substeps in [2, 4, 8] {
            let settings = scheme(substeps);
            let steps = ticks(SECONDS) as u32 * substeps;
            let fallen = height(mount, settings);
            let expected = sum(GRAVITY, substep(settings), steps);
            cases.push(Case::new(
                format!("free fall {SECONDS} s, N = 2, {}", label(settings)),
                expected,
                fallen,
                ROUNDING,
            ));
            errors.push(fallen + 0.5 * GRAVITY * SECONDS * SECONDS);
        }
        let name = format!("free fall, order in the step, {}", label(scheme(8)));
        cases.push(order(name, expected_order, &errors));
    }
    cases
}

/// Mean height after the fall, m.
fn height(mount: &Mount, settings: StepSettings) -> f64 {
    let scene = Scene { pins: Pins::Free, ..Scene::swing(3) };
    let mut specimen = mount(&scene, settings);
    run(specimen.as_mut(), SECONDS);
    let positions = specimen.positions();
    positions.iter().map(|x| f64::from(x.y)).sum::<f64>() / positions.len() as f64
}
