//! A free cloth without gravity or air keeps its momenta.

use bunting_solver::StepSettings;
use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        dumbbell::{BdfFormula, spin_left},
        rig::{GAUSS_SEIDEL, Substeps, YARNS, label, order, substep},
    },
    reference::grid::Grid,
    scenes::{Fabric, Pins, Pose, Scene},
    simulation::run,
    specimen::{Mount, Specimen},
};

/// Relative rounding error of a momentum: each correction rounds to a unit in the last place of a position,
/// 6e-8 m, which over a substep of 1/1200 s is a velocity; over 1200 substeps these add up to 1e-3 of 0.4 m/s.
const ROUNDING: f64 = 1e-3;
/// Spin of the dumbbell, rad/s.
const SPIN: f64 = 20.0;
/// Ticks of about one revolution.
const REVOLUTION: u32 = 19;
/// Relative error of the dumbbell's spin: it stretches by 2e-4 and is a thin sheet.
const DUMBBELL: f64 = 2e-3;

/// Cases of linear and angular momentum.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for settings in [YARNS, GAUSS_SEIDEL] {
        let (before, after) = drift(mount, settings);
        cases.push(Case::new(
            format!("linear momentum of a crumpled sheet, N = 6, {}, kg m/s", label(settings)),
            before.length(),
            before.length() + (after - before).length(),
            ROUNDING,
        ));
    }
    let schemes: [(BdfFormula, Substeps, [u32; 3], f64); 2] = [
        (BdfFormula::BDF2_OPT, StepSettings::yarns, [3, 6, 12], 2.0),
        (BdfFormula::BACKWARD_EULER, StepSettings::gauss_seidel, [10, 20, 40], 1.0),
    ];
    for (formula, scheme, sizes, expected_order) in schemes {
        let mut lost = Vec::new();
        for substeps in sizes {
            let settings = scheme(substeps);
            let kept = spin_kept(mount, settings);
            cases.push(Case::new(
                format!("spin of a dumbbell after a revolution, {}", label(settings)),
                spin_left(formula, SPIN, substep(settings), REVOLUTION * substeps),
                kept,
                DUMBBELL,
            ));
            lost.push(1.0 - kept);
        }
        let name = format!("spin of a dumbbell, order in the step, {}", label(scheme(sizes[2])));
        cases.push(order(name, expected_order, &lost));
    }
    cases
}

/// Momenta of a crumpled, moving sheet before and after a second, kg m/s.
fn drift(mount: &Mount, settings: StepSettings) -> (DVec3, DVec3) {
    let scene = Scene { pins: Pins::Free, pose: Pose::Vertical, gravity: 0.0, ..Scene::swing(7) };
    let crumple = |x: &DVec3| 0.1 * (7.0 * x.x + 3.0 * x.y).sin();
    let velocity = |x: &DVec3| {
        dvec3(0.3, -0.2, 0.1) + dvec3(0.0, 0.5, 2.0).cross(*x) + DVec3::Z * (5.0 * crumple(x))
    };
    let flat = scene.positions();
    let positions: Vec<DVec3> = flat.iter().map(|x| *x + DVec3::Z * crumple(x)).collect();
    let velocities: Vec<DVec3> = flat.iter().map(velocity).collect();
    let mut specimen = mount(&scene, settings);
    specimen.place(&positions, &velocities);
    let masses = Grid::new(&scene).masses;
    let before = velocities.iter().zip(&masses).map(|(v, m)| *v * *m).sum();
    run(specimen.as_mut(), 1.0);
    let moving = specimen.velocities().iter().zip(&masses);
    (before, moving.map(|(v, m)| v.as_dvec3() * *m).sum())
}

/// Fraction of the angular momentum that a sheet one metre long and one centimetre wide keeps in a revolution
/// about its middle.
fn spin_kept(mount: &Mount, settings: StepSettings) -> f64 {
    let scene = Scene {
        width: 0.01,
        pins: Pins::Free,
        pose: Pose::Vertical,
        gravity: 0.0,
        fabric: Fabric { stretch: [1e5, 1e5], ..Fabric::STANDARD },
        ..Scene::swing(2)
    };
    let positions = scene.positions();
    let masses = Grid::new(&scene).masses;
    let mass: f64 = masses.iter().sum();
    let centre = positions.iter().zip(&masses).map(|(x, m)| *x * *m).sum::<DVec3>() / mass;
    let velocities: Vec<DVec3> =
        positions.iter().map(|x| (DVec3::Z * SPIN).cross(*x - centre)).collect();
    let mut specimen = mount(&scene, settings);
    specimen.place(&positions, &velocities);
    let before = angular_momentum(specimen.as_ref(), &masses);
    (0..REVOLUTION).for_each(|_| specimen.tick());
    angular_momentum(specimen.as_ref(), &masses) / before
}

/// Angular momentum about z through the centre of mass, kg m²/s.
fn angular_momentum(specimen: &dyn Specimen, masses: &[f64]) -> f64 {
    let mean = |vectors: &[glam::Vec3]| {
        let weighted = vectors.iter().zip(masses).map(|(v, m)| v.as_dvec3() * *m);
        weighted.sum::<DVec3>() / masses.iter().sum::<f64>()
    };
    let (centre, drift) = (mean(specimen.positions()), mean(specimen.velocities()));
    let moving = specimen.positions().iter().zip(specimen.velocities()).zip(masses);
    moving.map(|((x, v), m)| m * (x.as_dvec3() - centre).cross(v.as_dvec3() - drift).z).sum()
}
