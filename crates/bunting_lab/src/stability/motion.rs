//! Moving frames, pins too far apart, and ticks of unusual lengths.

use std::f32::consts::{PI, TAU};

use bunting_solver::{ClothSnapshot, FrameMotion};
use glam::{DVec3, Quat, Vec3};

use super::{
    case::HardCase,
    rig::{REACH, RECOVERED, reach, speed, start, strain},
};
use crate::{
    product::{Cloth, TICK, fabric},
    scenes::{Pins, Pose, Scene, ticks},
    simulation::{Simulation, in_double, run},
    specimen::Specimen,
    stats::{rms_distance, worse},
};

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let n = if quick { 9 } else { 17 };
    let mut cases: Vec<HardCase> = [1e3, 1e4].into_iter().map(|offset| far(n, offset)).collect();
    cases.push(teleport_kept(n));
    cases.push(teleport_reset(n));
    let shake = |time: f32| (Vec3::X * (0.5 * (10.0 * TAU * time).sin()), Quat::IDENTITY);
    cases.extend(shaken("pin shake ±0.5 m at 10 Hz", n, shake));
    let spin = |time: f32| (Vec3::ZERO, Quat::from_rotation_y(20.0 * time));
    cases.extend(shaken("spin at 20 rad/s", n, spin));
    cases.extend([0.0, 1e-6, 0.5, 5.0].map(|tick| hitch(n, tick)));
    cases.push(overstretched(n));
    cases
}

/// Advances a cloth while its frame moves from pose to pose. Gravity stays that of the world.
fn carry(cloth: &mut Cloth, from: (Vec3, Quat), to: (Vec3, Quat)) {
    cloth.drive.motion = FrameMotion::between(from, to);
    cloth.drive.gravity = to.1.inverse() * Vec3::new(0.0, -9.81, 0.0);
    cloth.tick();
}

/// Case of the same swaying ride near the origin and far away, where poses are rounded.
fn far(n: usize, offset: f32) -> HardCase {
    let scene = Scene::hang_top(n);
    let pose = |offset: f32, tick: usize| {
        let sway = Vec3::Z * (0.5 * (3.0 * TICK * tick as f32).sin());
        (Vec3::splat(offset) + sway, Quat::IDENTITY)
    };
    let mut cloths = [0.0, offset].map(|offset| (offset, start(&scene)));
    for tick in 0..ticks(1.0) {
        for (offset, cloth) in &mut cloths {
            carry(cloth, pose(*offset, tick), pose(*offset, tick + 1));
        }
    }
    let apart =
        rms_distance(&in_double(cloths[0].1.positions()), &in_double(cloths[1].1.positions()));
    // A pose that is rounded to a unit in the last place of the offset shakes the pins by the same amount.
    let limit = f64::from(offset * f32::EPSILON) + 1e-4;
    HardCase::new(format!("{offset:e} m from the origin"), n, "RMS distance, m", apart, limit)
}

/// Case of a teleported cloth with its state kept, which must continue unchanged.
fn teleport_kept(n: usize) -> HardCase {
    let scene = Scene::swing(n);
    let mut stays = start(&scene);
    run(&mut stays, 0.3);
    let mut moved = stays.clone();
    moved.restore(&moved.batch.snapshot(0));
    let worst = (0..ticks(0.3)).fold(0.0, |worst: f64, _| {
        stays.tick();
        moved.tick();
        worse(worst, speed(&moved) / speed(&stays))
    });
    HardCase::new("teleport, state kept", n, "speed over that of none", worst, 1.05)
}

/// Case of a cloth reset elsewhere, turned by 180°, which must start from rest.
fn teleport_reset(n: usize) -> HardCase {
    let scene = Scene::swing(n);
    let mut cloth = start(&scene);
    run(&mut cloth, 0.3);
    cloth.drive.gravity = Quat::from_rotation_z(PI) * cloth.drive.gravity;
    cloth.restore(&ClothSnapshot::at_rest(&fabric(&scene)));
    cloth.tick();
    let free_fall = scene.gravity * f64::from(TICK);
    HardCase::new(
        "teleport, state reset",
        n,
        "speed over free fall's",
        speed(&cloth) / free_fall,
        1.05,
    )
}

/// Cases of a frame that is shaken for two seconds and then rests for two.
fn shaken(name: &str, n: usize, path: impl Fn(f32) -> (Vec3, Quat)) -> [HardCase; 2] {
    let scene = Scene::hang_side(n);
    let mut cloth = start(&scene);
    let mut worst = 0.0_f64;
    for tick in 0..ticks(2.0) {
        let [from, to] = [tick, tick + 1].map(|tick| path(tick as f32 * TICK));
        carry(&mut cloth, from, to);
        worst = worst.max(reach(&cloth));
    }
    cloth.drive.motion = FrameMotion::NONE;
    run(&mut cloth, 2.0);
    let left = 100.0 * strain(&scene, &cloth).p95;
    [
        HardCase::new(format!("{name}: bounded"), n, "reach, m", worst, REACH),
        HardCase::new(
            format!("{name}: recovers"),
            n,
            "95th percentile of strain, %",
            left,
            RECOVERED,
        ),
    ]
}

/// Case of one tick of an unusual length during a swing.
fn hitch(n: usize, tick: f32) -> HardCase {
    let mut cloth = start(&Scene::swing(n));
    run(&mut cloth, 0.2);
    cloth.advance(tick);
    let mut worst = reach(&cloth);
    for _ in 0..30 {
        cloth.tick();
        worst = worst.max(reach(&cloth));
    }
    HardCase::new(format!("hitch of {tick} s, not capped"), n, "reach, m", worst, REACH)
}

/// Case of two opposite edges held 10 % too far apart.
fn overstretched(n: usize) -> HardCase {
    let swing = Scene::swing(n);
    let scene = Scene { pins: Pins::TopAndBottom, pose: Pose::Vertical, damping: 2.0, ..swing };
    let mut cloth = start(&scene);
    let apart: Vec<DVec3> =
        scene.positions().iter().map(|x| *x * DVec3::new(1.0, 1.1, 1.0)).collect();
    cloth.place(&apart, &vec![DVec3::ZERO; apart.len()]);
    run(&mut cloth, 5.0);
    HardCase::new("pins at 110 %", n, "RMS speed, m/s", speed(&cloth), 1e-3)
}
