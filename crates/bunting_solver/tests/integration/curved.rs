//! Meshes that are curved at rest.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, TAU};
use std::sync::Arc;

use crate::common::{irregular, net};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount, StepLimits,
};
use glam::{Vec2, Vec3};

const TICK: f32 = 1.0 / 60.0;
/// Magnitude of gravity, m/s².
const GRAVITY: f32 = 9.81;

const STIFF: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 5e3,
    bend_stiffness: 1e-2,
    damping: 8.0,
    ..FabricMaterial::FLAG_POLYESTER
};

fn batch_of(fabric: &Arc<Fabric>, material: FabricMaterial, drive: Drive) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
    batch.drive(0, drive).expect("a lane");
    batch
}

/// Runs for some ticks, and returns the positions then.
fn run(batch: &mut ClothBatch, fabric: &Fabric, ticks: u32) -> Vec<Vec3> {
    let settings = StepLimits::default().of_fabric(fabric, TICK, GRAVITY);
    (0..ticks).for_each(|_| batch.step(TICK, settings));
    let mut positions = Vec::new();
    batch.copy_positions(0, &mut positions);
    positions
}

/// Radius of the quarter arc, m.
const RADIUS: f32 = 0.3;
/// Cells along the arc, and across it.
const CELLS: [u32; 2] = [16, 6];

/// A quarter of a circle that begins level, with vertices inside moved by up to a fifth of a cell, clamped over one more
/// cell.
fn quarter() -> Arc<Fabric> {
    let [along, across] = CELLS;
    let cell = RADIUS * FRAC_PI_2 / along as f32;
    let places: Vec<Vec2> = (0..=across)
        .flat_map(|row| (0..=along + 1).map(move |column| (column, row)))
        .map(|(column, row)| {
            let is_inner = column > 1 && column <= along && row > 0 && row < across;
            let phase = (row * 31 + column) as f32;
            let shift = Vec2::new(libm::sinf(2.3 * phase), libm::cosf(1.7 * phase)) * 0.2;
            let shift = if is_inner { shift } else { Vec2::ZERO };
            (Vec2::new(column as f32, row as f32) + shift) * cell
        })
        .collect();
    let bend = |at: &Vec2| {
        let angle = (at.x - cell) / RADIUS;
        let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
        Vec3::new(RADIUS * sin, RADIUS * (1.0 - cos), -at.y)
    };
    let corner = |column: u32, row: u32| row * (along + 2) + column;
    let cells = (0..across).flat_map(|row| (0..=along).map(move |column| (column, row)));
    let indices = cells.flat_map(|(column, row)| {
        let [a, b] = [corner(column, row), corner(column + 1, row)];
        let [c, d] = [corner(column, row + 1), corner(column + 1, row + 1)];
        if (row + column) % 3 == 0 { [a, c, d, a, d, b] } else { [a, c, b, b, c, d] }
    });
    let mesh = FabricBuilder::new(places.iter().map(bend).collect(), indices.collect());
    let clamped = (0..).zip(&places).filter(|(_, at)| at.x < 1.01 * cell).map(|(vertex, _)| vertex);
    let mesh = mesh.uv(places.clone()).pin(clamped.collect::<Vec<u32>>());
    net(&mesh)
}

/// How far the end of a quarter arc moves under a small load along −y, m, by Castigliano's theorem: the moment at the angle a is
/// q R² (cos a − (π/2 − a) sin a).
fn castigliano(load: f32) -> Vec2 {
    let scale = load * RADIUS.powi(4) / STIFF.bend_stiffness;
    scale * Vec2::new(FRAC_PI_4 / 2.0, FRAC_PI_2 - 1.25 - FRAC_PI_4 * FRAC_PI_4)
}

#[test]
fn a_clamped_quarter_arc_yields_as_castigliano_says() {
    let fabric = quarter();
    let load = 0.02 * STIFF.bend_stiffness / RADIUS.powi(3);
    let still = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
    let is_end = |rest: &Vec3| rest.truncate().distance(Vec2::splat(RADIUS)) < 1e-4;
    let tip = |at: &[Vec3]| {
        let of_end = fabric.rest_positions().iter().zip(at).filter(|(rest, _)| is_end(rest));
        let of_end: Vec<Vec2> = of_end.map(|(_, at)| at.truncate()).collect();
        of_end.iter().sum::<Vec2>() / of_end.len() as f32
    };
    let mut batch = batch_of(&fabric, STIFF, still);
    let before = tip(&run(&mut batch, &fabric, 60));
    let gravity = Vec3::NEG_Y * (load / STIFF.area_density);
    batch.drive(0, Drive { gravity, ..still }).expect("a lane");
    let moved = tip(&run(&mut batch, &fabric, 1200)) - before;
    let error = moved / castigliano(load) - 1.0;
    assert!(error.abs().max_element() < 0.06, "{error}");
}

/// A square metre rolled up about a vertical axis until its sides meet.
fn cylinder(n: u32, is_pinned: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
    let flat = irregular(n, 0.0);
    let around = |at: &Vec3| {
        let (sin, cos) = (libm::sinf(at.x * TAU), libm::cosf(at.x * TAU));
        Vec3::new(sin / TAU, at.y, cos / TAU)
    };
    let positions = flat.positions().iter().map(around).collect();
    let mesh = FabricBuilder::new(positions, flat.indices().to_vec());
    net(&mesh.weld_distance(1e-5).pin_where(|at, _| is_pinned(at)))
}

/// Strains of the edges of a mesh.
fn strains(fabric: &Fabric, at: &[Vec3]) -> Vec<f32> {
    let length = |of: &[Vec3], [a, b]: [u32; 2]| of[a as usize].distance(of[b as usize]);
    let sides = fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let rest = fabric.rest_positions();
    sides.map(|ends| length(at, ends) / length(rest, ends) - 1.0).collect()
}

/// A ring whose first and last row bend by themselves sags at its seam. Without gravity nothing moves it, and with it the
/// seam must sag as the rest of the ring does: the ring is as wide whether its seam is at its top or its side.
#[test]
fn a_ring_sags_alike_wherever_its_seam_is() {
    let material = FabricMaterial { bend_stiffness: 5e-3, ..STIFF };
    let heights = [Vec3::X, Vec3::NEG_Z, Vec3::NEG_X].map(|down| {
        // Held at the line opposite to where it sags.
        let fabric = cylinder(17, |at| {
            let radial = Vec3::new(at.x, 0.0, at.z);
            radial.dot(down) < -0.999 / TAU
        });
        let gravity = 2.0 * down;
        let mut batch =
            batch_of(&fabric, material, Drive { gravity, air_density: 0.0, ..Drive::default() });
        let at = run(&mut batch, &fabric, 900);
        at.iter().map(|at| at.dot(down)).fold(0.0, f32::max)
    });
    let mean = heights.iter().sum::<f32>() / heights.len() as f32;
    let sagged = mean - 1.0 / TAU;
    assert!(sagged > 0.01, "{sagged}");
    for height in heights {
        assert!((height - mean).abs() < 0.05 * sagged, "{height} for {mean} m");
    }
}

/// Lines that are solved open, and joined afterwards, let a ring open at its seam: 50 %.
#[test]
fn a_ring_in_a_wind_is_strained_no_more_at_its_seam() {
    let fabric = cylinder(17, |at| at.y == 0.0);
    let wind = Vec3::new(6.0, 0.0, 3.6);
    let mut batch =
        batch_of(&fabric, FabricMaterial::FLAG_POLYESTER, Drive { wind, ..Drive::default() });
    let mut all = Vec::new();
    for _ in 0..300 {
        let at = run(&mut batch, &fabric, 1);
        all.extend(strains(&fabric, &at));
    }
    all.sort_by(f32::total_cmp);
    let large = all[all.len() * 999 / 1000];
    assert!(large < 0.2, "99.9 %: {large}");
}

/// The bend at rest turns with frames that the nodes give, which has a moment: without `keep_spin` this ring turns by
/// itself, ever faster.
#[test]
fn a_stiff_free_ring_stays_at_rest() {
    let fabric = cylinder(17, |_| false);
    let material =
        FabricMaterial { bend_stiffness: 0.1, damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };
    let nothing = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
    let mut batch = batch_of(&fabric, material, nothing);
    run(&mut batch, &fabric, 600);
    let mut velocities = Vec::new();
    batch.copy_velocities(0, &mut velocities);
    let squares: f32 = velocities.iter().map(|velocity| velocity.length_squared()).sum();
    let speed = (squares / velocities.len() as f32).sqrt();
    assert!(speed < 2e-3, "{speed} m/s");
}
