//! Tests of the baselines against closed forms and against the reference.

use bunting_lab::{
    baselines::{Baseline, Method},
    oracles::free_fall::symplectic_euler,
    reference::{
        Reference,
        grid::Grid,
        verlet::{STEP_FRACTION, resolving_steps},
    },
    scenes::{Fabric, GRAVITY, Pins, Scene, TICK_RATE},
    stats::{Strain, rms_distance},
};
use glam::DVec3;

/// Relative error of single precision after some hundred additions.
const SINGLE: f64 = 1e-3;
/// Relative error of a static stretch in single precision: strains of 5e-4 in lengths of 1e-7.
const STRETCH: f64 = 2e-3;
/// Error of XPBD on the swing at 27 substeps, m RMS.
const XPBD_ERROR: f64 = 2e-3;
/// Error of symplectic Euler on the swing with steps that resolve the springs, m RMS.
const SYMPLECTIC_ERROR: f64 = 1e-3;
/// Distance from the origin beyond which a cloth has exploded, m.
const ARENA: f64 = 10.0;
/// Greatest ratio of a hanging cloth's mean strain with coarser cloths solved first to that without them.
const HIERARCHY: f64 = 0.5;
/// Ticks in 0.4 s.
const TICKS: usize = 24;

fn run(scene: &Scene, baseline: Baseline, ticks: usize) -> Vec<DVec3> {
    let mut simulation = baseline.start(scene);
    (0..ticks).for_each(|_| simulation.tick());
    simulation.positions().iter().map(|x| x.as_dvec3()).collect()
}

/// Distance from the reference of the 9 × 9 swing at 0.4 s, m RMS.
fn swing_error(method: Method, substeps: usize, passes: usize) -> f64 {
    let scene = Scene { seconds: 0.4, ..Scene::swing(9) };
    let reference = Reference::of(&scene);
    let positions = run(&scene, Baseline { method, substeps, passes }, TICKS);
    rms_distance(&reference.observation.compared[1], &positions)
}

#[test]
fn all_baselines_fall_freely() {
    let scene = Scene { pins: Pins::Free, ..Scene::swing(5) };
    for method in [
        Method::SymplecticEuler,
        Method::ImplicitEuler,
        Method::Jakobsen,
        Method::PbdDihedral,
        Method::PbdOverOne,
        Method::Hpbd,
        Method::Xpbd,
    ] {
        // The explicit method needs this many substeps to keep its springs still.
        let baseline = Baseline { method, substeps: 100, passes: 1 };
        let height = run(&scene, baseline, 6).iter().map(|x| x.y).sum::<f64>() / 25.0;
        let expected = symplectic_euler(GRAVITY, 1.0 / (f64::from(TICK_RATE) * 100.0), 600);
        assert!((height / expected - 1.0).abs() < SINGLE, "{method}: {height} m, not {expected} m");
    }
}

#[test]
fn implicit_euler_hangs_as_the_reference() {
    let fabric = Fabric { stretch: [1e3, 1e3], shear: 20.0, ..Fabric::STANDARD };
    let scene = Scene { fabric, ..Scene::hang_top(9) };
    let baseline = Baseline { method: Method::ImplicitEuler, substeps: 1, passes: 1 };
    let positions = run(&scene, baseline, scene.ticks());
    let mean = Strain::of(Grid::new(&scene).strains(&positions)).mean;
    let expected = Reference::of(&scene).observation.strain.mean;
    assert!((mean / expected - 1.0).abs() < STRETCH, "{mean}, not {expected}");
}

#[test]
fn explicit_euler_explodes_where_symplectic_euler_converges() {
    let steps = resolving_steps(&Grid::new(&Scene::swing(9)));
    assert!(swing_error(Method::SymplecticEuler, steps, 1) < SYMPLECTIC_ERROR);
    let exploded = swing_error(Method::ExplicitEuler, steps, 1);
    assert!(exploded.is_nan() || exploded > ARENA, "{exploded} m");
}

#[test]
fn symplectic_euler_explodes_past_its_stability_limit() {
    let steps = resolving_steps(&Grid::new(&Scene::swing(17))) as f64 * STEP_FRACTION;
    let scene = Scene { seconds: 0.4, ..Scene::swing(17) };
    let baseline =
        Baseline { method: Method::SymplecticEuler, substeps: (steps / 2.0) as usize, passes: 1 };
    assert!(run(&scene, baseline, TICKS).iter().any(|x| x.is_nan() || x.length() > ARENA));
}

#[test]
fn xpbd_converges_with_its_substeps() {
    // With more substeps single precision rounds gravity away: g h² nears the last place of a metre.
    let errors = [3, 9, 27].map(|substeps| swing_error(Method::Xpbd, substeps, 1));
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?} m");
    assert!(errors[2] < XPBD_ERROR, "{errors:?} m");
}

#[test]
fn implicit_euler_converges_with_its_substeps() {
    let errors = [1, 4, 16].map(|substeps| swing_error(Method::ImplicitEuler, substeps, 1));
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?} m");
}

#[test]
fn relaxation_stretches_less_with_more_passes() {
    let scene = Scene::hang_top(17);
    let grid = Grid::new(&scene);
    for method in [Method::Jakobsen, Method::PbdDihedral, Method::PbdOverOne] {
        let stretch = |passes| {
            let positions = run(&scene, Baseline { method, substeps: 1, passes }, 120);
            grid.strains(&positions).fold(0.0, f64::max)
        };
        let (few, many) = (stretch(4), stretch(32));
        assert!(few > 3.0 * many && many > 0.0, "{method}: {few} and {many}");
    }
}

#[test]
fn coarser_cloths_first_stretch_less() {
    let scene = Scene::hang_top(33);
    let grid = Grid::new(&scene);
    let stretch = |method| {
        let positions = run(&scene, Baseline { method, substeps: 1, passes: 4 }, 120);
        Strain::of(grid.strains(&positions)).mean
    };
    let (flat, hierarchical) = (stretch(Method::PbdOverOne), stretch(Method::Hpbd));
    assert!(hierarchical < HIERARCHY * flat, "{hierarchical} and {flat}");
}
