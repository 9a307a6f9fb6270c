//! Tests of the reference against closed forms, against itself at half the step, and against XPBD.

use std::f64::consts::PI;

use bunting_lab::{
    observation::COMPARED_TICKS,
    oracles::{
        bending::Cantilever,
        catenary::chain_sag,
        drag::BroadsideFall,
        pendulum::{amplitude_factor, chain_modes, stiff_period},
        stretch::hung_strip,
    },
    reference::{
        Reference,
        grid::Grid,
        verlet::{Verlet, resolving_steps},
        xpbd::Xpbd,
    },
    scenes::{Air, Fabric, GRAVITY, Pins, Pose, Scene, TICK_RATE},
    stats::{crossing_frequency, rms_distance},
};
use glam::{DVec3, dvec3};

/// Largest force left on a vertex at rest, N.
const REST: f64 = 1e-8;
/// Greatest number of steps to rest.
const STEPS: usize = 400_000;
/// Difference of the swing at 0.4 s between a step and its half, m RMS.
const STEP_DIFFERENCE: f64 = 1e-6;
/// Difference of the swing at 0.4 s between Verlet and XPBD at 200 × 4, m RMS.
const METHOD_DIFFERENCE: f64 = 3e-4;
/// Relative error of the stretch of a hanging strip: the second order of its strain.
const STRETCH: f64 = 1e-3;
/// Error of the sag over the length: the strain of the stiff sheet, 1e-4.
const SAG: f64 = 5e-4;
/// Relative error of the cantilever's aspect at N = 16; 13 % where the clamp is half as stiff.
const ASPECT: f64 = 1e-2;
/// Tolerance of an observed order of convergence.
const ORDER: f64 = 0.3;
/// Relative error of a period read from zero crossings.
const PERIOD: f64 = 1e-3;
/// Relative error of the first mode, with higher modes mixed in.
const MODE: f64 = 1e-2;
/// Relative error of the fall through air.
const FALL: f64 = 1e-5;
/// Change of the energy of an undamped swing, over the energy that it converts.
const ENERGY: f64 = 1e-6;

/// A strip of two columns, `segments` long cells over one metre.
fn strip(segments: usize, pins: Pins, pose: Pose, fabric: Fabric) -> Scene {
    Scene {
        columns: 2,
        rows: segments + 1,
        width: 1.0 / segments as f64,
        pins,
        pose,
        fabric,
        ..Scene::swing(segments + 1)
    }
}

fn start(scene: &Scene) -> Verlet {
    Verlet::new(scene, resolving_steps(&Grid::new(scene)))
}

fn settle(cloth: &mut Verlet, scene: &Scene) {
    let step = 1.0 / (f64::from(TICK_RATE) * resolving_steps(cloth.grid()) as f64);
    let residual = cloth.relax(step, REST, STEPS);
    assert!(residual < REST, "{} N left on {}", residual, scene.name);
}

#[track_caller]
fn assert_relative(measured: f64, expected: f64, tolerance: f64) {
    let error = (measured / expected - 1.0).abs();
    assert!(error < tolerance, "{measured} is {error:.2e} off {expected}, more than {tolerance:e}");
}

#[test]
fn hung_strip_stretches_the_same_at_every_resolution() {
    let fabric = Fabric { shear: 0.0, ..Fabric::STANDARD };
    for segments in [4, 8, 16] {
        let scene = strip(segments, Pins::Top, Pose::Vertical, fabric);
        let mut cloth = start(&scene);
        settle(&mut cloth, &scene);
        let tips = &cloth.positions[2 * segments..];
        let stretch = -0.5 * (tips[0].y + tips[1].y) - 1.0;
        assert_relative(
            stretch,
            hung_strip(fabric.density, GRAVITY, 1.0, fabric.stretch[1]),
            STRETCH,
        );
    }
}

#[test]
fn uniaxial_modulus_is_the_fabrics_in_spite_of_the_diagonals() {
    // A jersey resists shear as much as stretch; diagonals without correction would add 70 %.
    let fabric = Fabric { stretch: [60.0, 40.0], shear: 20.0, ..Fabric::STANDARD };
    let scene = Scene { gravity: 0.0, pins: Pins::Free, fabric, ..Scene::hang_top(5) };
    let grid = Grid::new(&scene);
    let stretched = |along: f64, across: f64| {
        let positions: Vec<DVec3> = scene
            .positions()
            .iter()
            .map(|x| dvec3(x.x * (1.0 + across), x.y * (1.0 + along), 0.0))
            .collect();
        2.0 * grid.elastic_energy(&positions)
    };
    let along = 1e-5;
    let modulus = (-1000..0)
        .map(|k| stretched(along, along * f64::from(k) * 1e-3))
        .fold(f64::INFINITY, f64::min)
        / (along * along);
    assert_relative(modulus, fabric.stretch[1], STRETCH);
}

#[test]
fn shear_energy_is_half_g_gamma_squared() {
    let scene = Scene { width: 0.5, ..Scene::hang_top(5) };
    let gamma = 1e-5;
    let sheared: Vec<DVec3> =
        scene.positions().iter().map(|x| dvec3(x.x + gamma * x.y, x.y, 0.0)).collect();
    let expected = 0.5 * scene.fabric.shear * gamma * gamma * scene.width * scene.height;
    assert_relative(Grid::new(&scene).elastic_energy(&sheared), expected, STRETCH);
}

#[test]
fn masses_add_up() {
    let masses = Grid::new(&Scene::hang_top(6)).masses;
    assert_relative(masses.iter().sum(), 0.2, 1e-12);
}

#[test]
fn slack_sheet_hangs_as_its_chain() {
    let (segments, span) = (8, 0.8);
    let fabric = Fabric { bending: 0.0, ..Fabric::STANDARD };
    let scene = strip(segments, Pins::TopAndBottom, Pose::Horizontal, fabric);
    let mut cloth = start(&scene);
    let half_drop = (0.25_f64 - 0.25 * span * span).sqrt();
    for x in &mut cloth.positions {
        let from_middle = (2.0 * x.z - 1.0).abs();
        *x = dvec3(x.x, half_drop * (from_middle - 1.0), span * x.z);
    }
    settle(&mut cloth, &scene);
    let sag = -cloth.positions[segments].y;
    assert!((sag - chain_sag(segments, span, 1.0)).abs() < SAG, "sag {sag}");
}

/// Relative error of the aspect H/W of a cantilever of `segments` segments at Γ = 10.
fn cantilever_error(segments: usize) -> f64 {
    let gamma = 10.0;
    let free = segments as f64 / (segments + 1) as f64;
    let fabric = Fabric { bending: 0.2 * GRAVITY * free.powi(3) / gamma, ..Fabric::STANDARD };
    let scene = strip(segments + 1, Pins::TopClamp, Pose::Horizontal, fabric);
    let mut cloth = start(&scene);
    settle(&mut cloth, &scene);
    let row = |j: usize| 0.5 * (cloth.positions[2 * j] + cloth.positions[2 * j + 1]);
    let reach = row(segments + 1) - row(1);
    -reach.y / reach.z / Cantilever::new(gamma).aspect() - 1.0
}

#[test]
fn cantilever_bends_as_romero_tabulates() {
    let [coarse, fine] = [8, 16].map(cantilever_error);
    assert!(fine.abs() < ASPECT, "{fine}");
    let order = (coarse / fine).log2();
    assert!((order - 2.0).abs() < ORDER, "order {order}");
}

/// Frequency in Hz of the tip over four seconds after a small tilt of a hanging sheet.
fn swing_frequency(scene: &Scene, shape: impl Fn(f64) -> f64) -> f64 {
    let mut cloth = start(scene);
    for x in &mut cloth.positions {
        x.z = shape(-x.y);
    }
    let tips: Vec<f64> = (0..240)
        .map(|_| {
            cloth.tick();
            cloth.positions[scene.vertices() - 1].z
        })
        .collect();
    crossing_frequency(&tips, f64::from(TICK_RATE)).expect("it swings")
}

#[test]
fn stiff_sheet_is_a_pendulum() {
    let fabric = Fabric { bending: 10.0, ..Fabric::STANDARD };
    let scene = strip(8, Pins::Top, Pose::Vertical, fabric);
    let amplitude = 0.05;
    let frequency = swing_frequency(&scene, |depth| amplitude * depth);
    assert_relative(
        1.0 / frequency,
        stiff_period(GRAVITY, 1.0, Some(8)) * amplitude_factor(amplitude),
        PERIOD,
    );
}

#[test]
fn limp_sheet_swings_in_its_first_mode() {
    // Shear couples the two columns, whose lumped masses differ from row to row.
    let fabric = Fabric { bending: 0.0, ..Fabric::STANDARD };
    let scene = strip(8, Pins::Top, Pose::Vertical, fabric);
    // The start is close to the first mode J₀(2.405 √(1 − s)), so that the fundamental determines the
    // crossings.
    let frequency = swing_frequency(&scene, |depth| 0.003 * depth * (0.6 + 0.4 * depth));
    assert_relative(frequency, chain_modes(8, 0.5)[0] * GRAVITY.sqrt() / (2.0 * PI), MODE);
}

#[test]
fn sheet_falls_through_air() {
    let fabric = Fabric { density: 0.1, ..Fabric::STANDARD };
    let air = Air { pressure: 1.2 * 1.225, ..Air::VACUUM };
    let scene = Scene { fabric, air, pins: Pins::Free, ..Scene::swing(3) };
    // Equal drag on unequal masses would bend the sheet: a rigid one falls flat.
    let rigid = Scene { fabric: Fabric { bending: 1.0, ..fabric }, ..scene };
    let mut cloth = start(&rigid);
    (0..30).for_each(|_| cloth.tick());
    let fall = BroadsideFall { gravity: GRAVITY, density: 0.1, drag: 1.2 * 1.225 };
    let mass: f64 = cloth.grid().masses.iter().sum();
    let depth = -cloth.grid().gravity_energy(1.0, &cloth.positions) / mass;
    assert_relative(depth, fall.depth(0.5), FALL);
}

#[test]
fn swing_keeps_its_energy() {
    let scene = Scene::swing(9);
    let mut cloth = start(&scene);
    (0..24).for_each(|_| cloth.tick());
    let (grid, turned) = (cloth.grid(), cloth.grid().kinetic_energy(&cloth.velocities));
    let total = turned
        + grid.elastic_energy(&cloth.positions)
        + grid.gravity_energy(GRAVITY, &cloth.positions);
    assert!(total.abs() < ENERGY * turned, "{total} J of {turned} J");
}

/// Asserts that the swing at 0.4 s depends neither on the step nor on the method.
fn assert_converged(n: usize) {
    let scene = Scene::swing(n);
    let reference = Reference::run(&scene, resolving_steps(&Grid::new(&scene)));
    let mut xpbd = Xpbd::new(&scene, 200, 4);
    let mut method_errors = Vec::new();
    for tick in 1..=scene.ticks() {
        xpbd.tick();
        if let Some(k) = COMPARED_TICKS.iter().position(|compared| *compared == tick) {
            method_errors.push(rms_distance(&reference.observation.compared[k], &xpbd.positions));
        }
    }
    let step_errors = reference.step_errors;
    println!("{n}: {step_errors:?} m between steps, {method_errors:?} m between methods");
    assert!(step_errors[1] < STEP_DIFFERENCE, "{step_errors:?} m between steps");
    assert!(method_errors[1] < METHOD_DIFFERENCE, "{method_errors:?} m between methods");
}

#[test]
fn swing_is_converged_and_xpbd_agrees() {
    assert_converged(9);
}

#[test]
#[ignore = "takes ten seconds"]
fn large_swing_is_converged_and_xpbd_agrees() {
    assert_converged(33);
}

#[test]
fn the_reference_of_a_hanging_scene_is_at_rest() {
    let scene = Scene { seconds: 2.0, ..Scene::hang_top(5) };
    let reference = Reference::run(&scene, 400);
    assert!(reference.residual.expect("measured at rest") < REST);
    let strain = reference.observation.strain;
    assert_relative(strain.mean, 0.5 * hung_strip(0.2, GRAVITY, 1.0, 1e4), 0.05);
}
