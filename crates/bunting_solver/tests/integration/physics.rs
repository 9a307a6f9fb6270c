//! Tests of laws of motion that hold in every scheme: in the default one, and in Gauss–Seidel if it differs.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, LinkFamily, StepSettings,
};
use glam::{Quat, Vec3};

use crate::common::net;

const TICK: f32 = 1.0 / 60.0;
const GRAVITY: f32 = 9.81;

/// The standard scenes' material: σ = 0.2, Y = 1e4, G = 200, B = 2e-5, without damping, air or contact.
const STANDARD: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 200.0,
    bend_stiffness: 2e-5,
    damping: 0.0,
    internal_damping: 0.0,
    pressure_coefficient: 0.0,
    friction_coefficient: 0.0,
    thickness: 0.0,
    surface_friction: 0.0,
};

/// The default settings, and Gauss–Seidel with the given number of substeps.
fn schemes(substeps: u32) -> [StepSettings; 2] {
    [StepSettings::default(), StepSettings::gauss_seidel(substeps)]
}

fn square(n: u32, pinned: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
    let builder =
        FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin_where(|position, _| pinned(position));
    Arc::new(builder.build().expect("a good fabric"))
}

fn lone(fabric: &Arc<Fabric>, material: FabricMaterial, drive: Drive) -> ClothBatch {
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("a free lane");
    batch.drive(lane, drive).expect("a good drive");
    batch
}

fn mean_strain(fabric: &Fabric, positions: &[Vec3], family: LinkFamily) -> f32 {
    let strains: Vec<f32> = fabric
        .links()
        .iter()
        .filter(|link| link.family == family)
        .map(|link| {
            let [a, b] = link.particles.map(|particle| positions[particle as usize]);
            a.distance(b) / link.rest_length - 1.0
        })
        .collect();
    strains.iter().sum::<f32>() / strains.len() as f32
}

/// Backward Euler from rest: Σ g h² i over n steps is g h² n (n + 1)/2. `yarns.rs` has the sum of the default scheme.
#[test]
fn gauss_seidel_falls_as_backward_euler() {
    let fabric = square(5, |_| false);
    let mut batch = lone(&fabric, STANDARD, Drive::default());
    let settings = StepSettings::gauss_seidel(4);
    for _ in 0..30 {
        batch.step(TICK, settings);
    }
    let n = 120.0;
    let h = TICK / 4.0;
    let expected = -GRAVITY * h * h * n * (n + 1.0) / 2.0;
    for (now, rest) in batch.snapshot(0).positions.iter().zip(fabric.rest_positions()) {
        let fallen = *now - *rest;
        assert!(
            (fallen.y - expected).abs() < 1e-4 * expected.abs() && fallen.x.abs() < 1e-4,
            "{fallen} {expected}"
        );
    }
}

/// A fall has the same acceleration in every tick, whatever its substeps, since the formulas are of second order.
#[test]
fn a_change_of_substeps_does_not_jerk_a_fall() {
    let grid = square(12, |_| false);
    let triangles = grid.triangles().as_flattened().to_vec();
    let mesh = net(&FabricBuilder::new(grid.rest_positions().to_vec(), triangles));
    for fabric in [grid, mesh] {
        let drive = Drive { gravity: Vec3::NEG_Z * GRAVITY, ..Drive::NONE };
        let mut batch = lone(&fabric, STANDARD, drive);
        let mut heights = Vec::new();
        for substeps in [8, 8, 4, 4, 2, 4, 2, 2] {
            batch.begin_tick(TICK, StepSettings::yarns(substeps));
            for _ in 0..substeps {
                batch.integrate();
                batch.solve_constraints();
                batch.update_velocities();
            }
            heights.push(batch.snapshot(0).positions[7].z);
        }
        for fall in heights.windows(3).skip(1) {
            let acceleration = (2.0 * fall[1] - fall[0] - fall[2]) / (TICK * TICK);
            assert!((acceleration / GRAVITY - 1.0).abs() < 1e-2, "{acceleration} {heights:?}");
        }
    }
}

#[test]
fn a_hanging_sheet_stretches_as_its_material_says() {
    let soft = FabricMaterial {
        warp_stiffness: 100.0,
        weft_stiffness: 100.0,
        shear_stiffness: 1.0,
        damping: 3.0,
        ..STANDARD
    };
    // Gauss–Seidel leaves a numerical compliance of h²/(k m), which 30 substeps bring below 2 %. Chains are
    // solved exactly.
    for (settings, tolerance) in
        [(StepSettings::default(), 2e-3), (StepSettings::gauss_seidel(30), 0.02)]
    {
        for n in [5, 9] {
            let fabric = square(n, |position| position.y == 0.0);
            let mut batch = lone(&fabric, soft, Drive::default());
            for _ in 0..400 {
                batch.step(TICK, settings);
            }
            let strain = mean_strain(&fabric, &batch.snapshot(0).positions, LinkFamily::Weft);
            let expected = soft.area_density * GRAVITY / (2.0 * soft.weft_stiffness);
            let error = strain / expected - 1.0;
            assert!(error.abs() < tolerance, "{n}, {settings:?}: {strain} {expected}");
        }
    }
}

#[test]
fn broadside_fall_reaches_terminal_speed() {
    let fabric = square(5, |_| false);
    let material = FabricMaterial { area_density: 0.1, pressure_coefficient: 1.2, ..STANDARD };
    // The sheet lies in the xy plane and falls along z, to v_t² = 2σg/(ρ C).
    let drive = Drive { gravity: Vec3::new(0.0, 0.0, -GRAVITY), ..Drive::default() };
    let expected = (2.0 * 0.1 * GRAVITY / (1.225_f32 * 1.2)).sqrt();
    // Each step of backward Euler slows v by av/(1 + a²) with a = gh v/v_t², and adds gh: v equals v_t except
    // for a²/2, which is 2.5e-5 with 20 substeps.
    for settings in schemes(20) {
        let mut batch = lone(&fabric, material, drive);
        for _ in 0..60 {
            batch.step(TICK, settings);
        }
        let velocity = batch.snapshot(0).velocities[12].z;
        assert!((velocity / -expected - 1.0).abs() < 1e-4, "{settings:?}: {velocity} {expected}");
    }
}

/// dv/dt = −k v² with k = ½ρC/σ: v = v₀/(1 + k v₀ t).
#[test]
fn drag_alone_slows_by_its_closed_form() {
    let material = FabricMaterial { area_density: 0.1, pressure_coefficient: 1.2, ..STANDARD };
    let fabric = square(3, |_| false);
    let mut start = ClothSnapshot::at_rest(&fabric);
    start.velocities.fill(Vec3::new(0.0, 0.0, 20.0));
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    batch.insert(&start, material).expect("a free lane");
    batch.drive(0, Drive { gravity: Vec3::ZERO, ..Drive::default() }).expect("a good drive");
    for tick in 1..=60 {
        batch.step(TICK, StepSettings::yarns(2));
        let k = 0.5 * 1.225 * 1.2 / 0.1;
        let expected = 20.0 / (1.0 + k * 20.0 * tick as f32 * TICK);
        let velocity = batch.snapshot(0).velocities[4].z;
        assert!((velocity / expected - 1.0).abs() < 1e-4, "tick {tick}: {velocity} {expected}");
    }
}

/// A sheet that hangs in a steady wind stands at the slope θ at which ½ρCW² cos²θ = σg sin θ, whatever the
/// step. Drag made implicit as if nothing held the cloth would lose a seventh of the force.
#[test]
fn a_pinned_sheet_feels_all_of_the_wind() {
    let fabric = square(3, |at| at.y == 0.0);
    let material = FabricMaterial {
        area_density: 0.1,
        pressure_coefficient: 1.2,
        bend_stiffness: 0.0,
        damping: 2.0,
        ..STANDARD
    };
    let (wind, lightness) = (1.5_f32, 0.1 * GRAVITY / (0.5 * 1.225 * 1.2));
    let slope = lightness / (2.0 * wind * wind);
    let expected = (1.0 + slope * slope).sqrt() - slope;
    for substeps in [1, 2, 4] {
        let drive = Drive { wind: Vec3::new(0.0, 0.0, wind), ..Drive::default() };
        let mut batch = lone(&fabric, material, drive);
        (0..600).for_each(|_| batch.step(TICK, StepSettings::yarns(substeps)));
        let out = batch.snapshot(0).positions[7].z;
        assert!((out / expected - 1.0).abs() < 5e-3, "{substeps} substeps: {out} {expected}");
    }
}

#[test]
fn wind_pushes_a_turning_plate_as_it_lies_in_the_middle_of_a_substep() {
    const SPIN: f32 = 20.0;
    let grid = FabricBuilder::grid(Grid::new(2, 2, 0.1, 0.1));
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let areas = fabric.particle_areas();
    let centre =
        fabric.rest_positions().iter().zip(areas).map(|(at, &area)| *at * area).sum::<Vec3>()
            / fabric.area();
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    let positions: Vec<Vec3> = fabric.rest_positions().iter().map(|at| *at - centre).collect();
    let velocities: Vec<Vec3> = positions.iter().map(|at| (SPIN * Vec3::X).cross(*at)).collect();
    let weak = FabricMaterial { pressure_coefficient: 0.01, ..STANDARD };
    let lane = batch.insert(&ClothSnapshot::new(positions, velocities), weak).expect("good");
    let wind = Vec3::new(0.0, 0.0, 20.0);
    batch.drive(lane, Drive { wind, air_density: 1.2, ..Drive::NONE }).expect("a good drive");
    batch.step(TICK, StepSettings { substeps: 1, ..StepSettings::default() });
    let mut velocities = Vec::new();
    batch.copy_velocities(lane, &mut velocities);
    let drift: Vec3 = velocities.iter().zip(areas).map(|(speed, &area)| *speed * area).sum();
    // The plate turns from z towards −y.
    let angle = libm::atan2f(-drift.y, drift.z);
    assert!((angle - 0.5 * SPIN * TICK).abs() < 0.01, "pushed at {angle} rad");
}

/// Drag is implicit: a light sheet in a storm speeds up to the wind within a tick, and never beyond it.
#[test]
fn strong_wind_never_overshoots() {
    const WIND: f32 = 40.0;
    let material = FabricMaterial { area_density: 0.02, pressure_coefficient: 1.2, ..STANDARD };
    let drive = Drive { gravity: Vec3::ZERO, wind: Vec3::new(0.0, 0.0, WIND), ..Drive::default() };
    for n in [3, 9] {
        for settings in schemes(1) {
            let mut batch = lone(&square(n, |_| false), material, drive);
            let mut slowest = 0.0;
            for _ in 0..20 {
                batch.step(TICK, settings);
                let speeds = batch.snapshot(0).velocities.into_iter().map(|v| v.z);
                let [low, high] = [f32::min, f32::max].map(|of| speeds.clone().reduce(of));
                let (low, high) = (low.expect("a sheet"), high.expect("a sheet"));
                assert!(low >= slowest && high <= WIND, "{n}, {settings:?}: {low}..{high} m/s");
                slowest = low;
            }
            // The closed form is v = W − W/(1 + k W t), after a third of a second.
            let lag = 1.0 + 0.5 * 1.225 * 1.2 / 0.02 * WIND * 20.0 * TICK;
            let expected = WIND - WIND / lag;
            assert!((slowest / expected - 1.0).abs() < 1e-3, "{slowest} {expected}");
        }
    }
}

/// The motion in the world does not depend on the frame in which it is computed.
#[test]
fn a_moving_frame_changes_nothing_in_the_world() {
    let fabric = square(5, |_| false);
    let motion = FrameMotion {
        rotation: Quat::from_euler(glam::EulerRot::XYZ, 0.05, 0.1, -0.07),
        translation: Vec3::new(0.03, -0.01, 0.02),
    };
    for settings in schemes(8) {
        let mut fixed = lone(&fabric, STANDARD, Drive::default());
        let mut moving = lone(&fabric, STANDARD, Drive::default());
        let (mut origin, mut axes) = (Vec3::ZERO, Quat::IDENTITY);
        for _ in 0..20 {
            origin += axes * motion.translation;
            axes = (axes * motion.rotation).normalize();
            let gravity = axes.inverse() * Vec3::NEG_Y * GRAVITY;
            moving.drive(0, Drive { motion, gravity, ..Drive::default() }).expect("a good drive");
            fixed.step(TICK, settings);
            moving.step(TICK, settings);
        }
        let (fixed, moving) = (fixed.snapshot(0), moving.snapshot(0));
        for (here, there) in fixed.positions.iter().zip(&moving.positions) {
            let there = origin + axes * *there;
            assert!(here.distance(there) < 2e-4, "{settings:?}: {here} {there}");
        }
        for (here, there) in fixed.velocities.iter().zip(&moving.velocities) {
            let there = axes * *there;
            assert!(here.distance(there) < 2e-3, "{settings:?}: {here} {there}");
        }
    }
}

#[test]
fn damping_does_not_hold_back_a_frame_that_travels() {
    let fabric = square(5, |position| position.x == 0.0);
    let material = FabricMaterial { damping: 20.0, ..STANDARD };
    let motion = FrameMotion { translation: Vec3::new(0.0, 0.0, 20.0 * TICK), ..FrameMotion::NONE };
    let mut start = ClothSnapshot::at_rest(&fabric);
    start.velocities.fill(Vec3::Z * 20.0);
    for settings in schemes(4) {
        let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
        batch.insert(&start, material).expect("a free lane");
        batch
            .drive(0, Drive { motion, gravity: Vec3::ZERO, ..Drive::default() })
            .expect("a good drive");
        for _ in 0..60 {
            batch.step(TICK, settings);
        }
        for (now, rest) in batch.snapshot(0).positions.iter().zip(fabric.rest_positions()) {
            assert!(now.distance(*rest) < 1e-5, "{settings:?}: {now} {rest}");
        }
    }
}
