//! Regions in which the material differs: closed forms, uniform factors, and the same bits in all layouts.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Entering, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    MaterialRegion, Resolution, StepSettings,
};
use glam::{Quat, Vec2, Vec3};

use crate::common::{drive, irregular};

const TICK: f32 = 1.0 / 60.0;
const GRAVITY: f32 = 9.81;

/// A material that comes to rest.
const DAMPED: FabricMaterial = FabricMaterial {
    area_density: 0.12,
    warp_stiffness: 400.0,
    weft_stiffness: 400.0,
    bend_stiffness: 1e-4,
    damping: 4.0,
    pressure_coefficient: 0.0,
    friction_coefficient: 0.0,
    ..FabricMaterial::COTTON
};

fn everywhere() -> MaterialRegion {
    MaterialRegion::uv_box(Vec2::splat(-1.0), Vec2::splat(2.0))
}

/// An irregular mesh that hangs from its top, with a kink, so that it is no grid.
fn net() -> FabricBuilder {
    let flat = irregular(9, 0.4);
    let kinked = flat.positions().iter().map(|at| *at + Vec3::Z * 0.3 * (at.x - 0.4).max(0.0));
    let mesh = FabricBuilder::new(kinked.collect(), flat.indices().to_vec());
    let net = mesh.uv(flat.uvs().to_vec()).pin_where(|at, _| at.y == 0.0);
    assert!(built(net.clone()).grid().is_none());
    net
}

fn built(builder: FabricBuilder) -> Arc<Fabric> {
    Arc::new(builder.build().expect("a good fabric"))
}

/// The state after some ticks, alone.
fn after(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    settings: StepSettings,
    ticks: usize,
) -> ClothSnapshot {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("a lane");
    for _ in 0..ticks {
        batch.step(TICK, settings);
    }
    assert!(batch.is_finite(lane));
    batch.snapshot(lane)
}

fn positions(fabric: &Arc<Fabric>, material: FabricMaterial, ticks: usize) -> Vec<Vec3> {
    after(fabric, material, StepSettings::yarns(8), ticks).positions
}

#[test]
fn upper_links_are_strained_by_the_weight_below_them() {
    let (columns, rows) = (5, 33);
    let half = |low: f32, high: f32| MaterialRegion::uv_box(Vec2::Y * low, Vec2::new(1.0, high));
    let grid = FabricBuilder::grid(Grid::new(columns, rows, 0.2, 1.0));
    let grid = grid.pin_where(|_, uv| uv.y == 0.0);
    let fabric = built(grid.regions([half(0.5, 1.0).density(5.0), half(0.0, 0.5).stretch(2.0)]));
    let at = positions(&fabric, DAMPED, 400);
    let link = 1.0 / (rows - 1) as f32;
    for row in 0..rows - 1 {
        let middle = (row as f32 + 0.5) * link;
        let below = 5.0 * (1.0 - middle).min(0.5) + (0.5 - middle).max(0.0);
        let factor = if middle < 0.5 { 2.0 } else { 1.0 };
        // Half of the links at the border between both lies in each, which softens the upper one.
        let factor = match row {
            15 => 2.0 / (1.0 / 2.0 + 1.0 / 1.5),
            16 => 2.0 / (1.0 + 1.0 / 1.5),
            _ => factor,
        };
        let expected = DAMPED.area_density * GRAVITY * below / (factor * DAMPED.weft_stiffness);
        for column in 0..columns {
            let [upper, lower] = [row, row + 1].map(|row| at[(row * columns + column) as usize]);
            let strain = upper.distance(lower) / link - 1.0;
            let off = (strain - expected).abs();
            assert!(off < 0.01 * expected + 2e-5, "row {row}: {strain}, not {expected}");
        }
    }
}

/// How far the free end of the line of particles at `u` droops and reaches of a sheet that is clamped level at v = 0.
fn droop(fabric: &Fabric, at: &[Vec3], columns: usize, column: usize) -> Vec2 {
    let rows = fabric.particle_count() / columns;
    let [clamp, tip] = [1, rows - 1].map(|row| at[row * columns + column]);
    Vec2::new(clamp.y - tip.y, tip.z - clamp.z)
}

/// A sheet that lies level, of columns and rows over a width and a length, m, clamped by its first two rows.
fn cantilever([columns, rows]: [u32; 2], [width, length]: [f32; 2]) -> FabricBuilder {
    let grid = FabricBuilder::grid(Grid::new(columns, rows, width, length));
    let lies = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    grid.placed(lies, Vec3::ZERO).pin(0..2 * columns)
}

#[test]
fn a_strip_with_a_batten_bends_as_one_of_their_mean_stiffness() {
    // The batten is narrower than a cell, and lies between columns.
    let (columns, size) = (9, [0.12, 1.0]);
    let (width, factor) = (0.01, 4000.0);
    let strip = || cantilever([columns, 33], size);
    let batten = |u| MaterialRegion::uv_line(Vec2::new(u, 0.0), Vec2::new(u, 1.0), width);
    let material = FabricMaterial { warp_stiffness: 4e3, weft_stiffness: 4e3, ..DAMPED };
    let material = FabricMaterial { bend_stiffness: 6e-4, ..material };
    let mean = 1.0 + (factor - 1.0) * width / size[0];
    let stiff = FabricMaterial { bend_stiffness: mean * material.bend_stiffness, ..material };
    let plain = built(strip());
    let expected = droop(&plain, &positions(&plain, stiff, 300), 9, 4);
    assert!(expected.x > 0.1 && expected.x < 0.6, "{expected}");
    for u in [0.5, 0.46] {
        let fabric = built(strip().regions([batten(u).bending(factor)]));
        let found = droop(&fabric, &positions(&fabric, material, 300), 9, 4);
        assert!(found.distance(expected) < 0.02 * expected.length(), "{found}, not {expected}");
    }
}

#[test]
fn cloth_beside_a_batten_is_as_soft() {
    let (columns, size) = (25, [1.2, 0.5]);
    let sheet = || cantilever([columns, 17], size);
    let plain = built(sheet());
    let batten = MaterialRegion::uv_box(Vec2::ZERO, Vec2::new(0.125, 1.0)).bending(1e4);
    let battened = built(sheet().regions([batten]));
    let material = FabricMaterial { bend_stiffness: 2e-5, ..DAMPED };
    let of = |fabric: &Arc<Fabric>, material| {
        let at = positions(fabric, material, 300);
        [0, 22].map(|column| droop(fabric, &at, 25, column))
    };
    let soft = of(&plain, material);
    let both = of(&battened, material);
    // It hangs by what the batten draws it aside.
    assert!(both[1].distance(soft[1]) < 0.1, "{} beside it, alone {}", both[1], soft[1]);
    assert!(soft[0].x > 0.4 && both[0].x < 0.2, "{} at it, without {}", both[0], soft[0]);
}

/// Materials that are the same, one by a region.
fn scaled() -> (MaterialRegion, FabricMaterial) {
    let region = everywhere().stretch(3.0).bending(40.0).density(1.5);
    let material = FabricMaterial {
        area_density: 1.5 * DAMPED.area_density,
        warp_stiffness: 3.0 * DAMPED.warp_stiffness,
        weft_stiffness: 3.0 * DAMPED.weft_stiffness,
        shear_stiffness: 3.0 * DAMPED.shear_stiffness,
        bend_stiffness: 40.0 * DAMPED.bend_stiffness,
        ..DAMPED
    };
    (region, material)
}

#[test]
fn a_factor_everywhere_is_another_material() {
    let (region, material) = scaled();
    let grids = [
        FabricBuilder::grid(Grid::new(17, 13, 0.8, 0.6)).pin([0, 16]),
        FabricBuilder::grid(Grid::new(2, 13, 0.05, 0.6)).pin([0, 1]),
        FabricBuilder::grid(Grid::new(17, 13, 0.8, 0.6)).pin_where(|_, uv| uv.x == 0.0),
        net(),
    ];
    for builder in grids {
        for settings in [StepSettings::yarns(4), StepSettings::gauss_seidel(6)] {
            let by_region = built(builder.clone().regions([region.clone()]));
            let plain = built(builder.clone());
            let heavier = by_region.mass_area() / plain.area();
            assert!(
                (heavier - 1.5).abs() < 1e-4,
                "{heavier}, {} particles",
                plain.particle_count()
            );
            let found = after(&by_region, DAMPED, settings, 40).positions;
            let expected = after(&plain, material, settings, 40).positions;
            let pairs = found.iter().zip(&expected);
            let off = pairs.map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
            let count = plain.particle_count();
            assert!(off < 1e-3, "{off} m, {count} particles, {settings:?}");
        }
    }
}

fn bits(state: &ClothSnapshot) -> Vec<u32> {
    let vectors = state.positions.iter().chain(&state.velocities);
    vectors.flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
}

#[test]
fn factors_of_one_change_no_bit() {
    let nowhere = MaterialRegion::uv_box(Vec2::splat(5.0), Vec2::splat(6.0));
    let regions = [
        everywhere(),
        nowhere.stretch(9.0).bending(9.0).density(9.0),
        MaterialRegion::depth(|_| 0.0).stretch(9.0).bending(9.0).density(9.0),
    ];
    for builder in [FabricBuilder::grid(Grid::new(17, 13, 0.8, 0.6)).pin([0, 16]), net()] {
        let plain = built(builder.clone());
        let varied = built(builder.regions(regions.clone()));
        let [plain, varied] =
            [plain, varied].map(|it| after(&it, DAMPED, StepSettings::yarns(3), 60));
        assert!(bits(&plain) == bits(&varied));
    }
}

/// A hem, a batten and a curve of depth.
fn several() -> [MaterialRegion; 3] {
    let (from, to) = (Vec2::new(0.1, 0.4), Vec2::new(0.9, 0.55));
    [
        MaterialRegion::uv_box(Vec2::new(0.0, 0.9), Vec2::ONE).density(3.0).stretch(2.0),
        MaterialRegion::uv_line(from, to, 0.04).bending(3e3),
        MaterialRegion::depth(|depth| 1.0 - depth).bending(4.0).stretch(0.5),
    ]
}

/// Flies a cloth in a lane of a batch.
fn fly(batch: &mut ClothBatch, lane: usize) -> Vec<u32> {
    for tick in 0..60 {
        batch.drive(lane, drive(1, tick)).expect("a good drive");
        batch.step(TICK, StepSettings::yarns(3));
    }
    assert!(batch.is_finite(lane));
    bits(&batch.snapshot(lane))
}

#[test]
fn bits_are_the_same_alone_and_among_others() {
    let grid = || FabricBuilder::grid(Grid::new(13, 9, 0.7, 0.5)).pin([0, 12]);
    for builder in [grid(), net()] {
        let fabric = built(builder.regions(several()));
        let at_rest = ClothSnapshot::at_rest(&fabric);
        let mut alone = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        alone.replace(0, &at_rest, FabricMaterial::COTTON).expect("a lane");
        let expected = fly(&mut alone, 0);
        let mut eight = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        eight.replace(1, &at_rest, FabricMaterial::DENIM).expect("a lane");
        eight.replace(5, &at_rest, FabricMaterial::COTTON).expect("a lane");
        assert!(fly(&mut eight, 5) == expected);
        if fabric.grid().is_none() {
            continue;
        }
        let others = [built(grid()), Arc::clone(&fabric)];
        let mut mixed = ClothBatch::mixed(&others[0]).expect("grids");
        let states = others.each_ref().map(|fabric| ClothSnapshot::at_rest(fabric));
        let entering = |lane: usize| Entering {
            lane,
            fabric: &others[lane],
            snapshot: &states[lane],
            material: FabricMaterial::COTTON,
        };
        mixed.exchange(&[], &[entering(0), entering(1)]).expect("one topology");
        assert!(fly(&mut mixed, 1) == expected);
    }
}

#[test]
fn a_region_covers_as_much_at_every_resolution() {
    let sheet = |columns: u32, rows: u32| FabricBuilder::grid(Grid::new(columns, rows, 2.0, 1.0));
    let mesh = |columns: u32, rows: u32| {
        let grid = sheet(columns, rows);
        let mesh = FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec());
        // A kink, so that it is no rectangle.
        let bent = |at: &Vec3| *at + Vec3::Z * 0.5 * at.x.min(1.0);
        let positions = mesh.positions().iter().map(bent).collect();
        FabricBuilder::new(positions, mesh.indices().to_vec()).uv(grid.uvs().to_vec())
    };
    let width = 0.03;
    for (from, to) in
        [([0.0, 0.37], [1.0, 0.37]), ([0.11, 0.0], [0.11, 1.0]), ([0.5, 0.2], [0.8, 0.9])]
    {
        let (from, to) = (Vec2::from_array(from), Vec2::from_array(to));
        let region = MaterialRegion::uv_line(from, to, width).density(5.0);
        let on = |builder: FabricBuilder, length: f32| {
            let expected = 4.0 * width * length;
            let fabric = builder.regions([region.clone()]).build().expect("a fabric");
            let found = fabric.mass_area() - fabric.area();
            let count = fabric.particle_count();
            assert!((found / expected - 1.0).abs() < 0.05, "{found} of {expected}, {count}");
        };
        let away = to - from;
        let flat = (away * Vec2::new(2.0, 1.0)).length();
        on(sheet(33, 17), flat);
        on(sheet(9, 5), flat);
        // On the bent mesh a unit of u is longer on its first half.
        let bent = |u: f32| 1.25_f32.sqrt() * 2.0 * u.min(0.5) + 2.0 * (u - 0.5).max(0.0);
        let along = bent(to.x) - bent(from.x);
        on(mesh(9, 5), Vec2::new(along, away.y).length());
    }
}

#[test]
fn regions_do_not_leak_across_a_seam_of_the_texture() {
    // A tube whose texture begins and ends along one line; the weld joins its vertices there.
    let (around, height, radius) = (48, 12, 0.3);
    let mut builder_uv = Vec::new();
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for row in 0..=height {
        for column in 0..=around {
            let (u, v) = (column as f32 / around as f32, row as f32 / height as f32);
            let (sin, cos) = libm::sincosf(core::f32::consts::TAU * u);
            positions.push(Vec3::new(radius * cos, -0.6 * v, radius * sin));
            builder_uv.push(Vec2::new(u, v));
            if row < height && column < around {
                let a = row * (around + 1) + column;
                let below = a + around + 1;
                indices.extend([a, a + 1, below, a + 1, below + 1, below]);
            }
        }
    }
    let skirt = FabricBuilder::new(positions, indices).uv(builder_uv).weld_distance(1e-4);
    let bone = MaterialRegion::uv_line(Vec2::new(0.5, 0.0), Vec2::new(0.5, 1.0), 0.02).density(9.0);
    let made = skirt.regions([bone]).resampled(Resolution::CellSize(0.05)).expect("a skirt");
    let plain = skirt_areas(&made.fabric);
    for (particle, at) in made.fabric.rest_positions().iter().enumerate() {
        let is_heavy = made.fabric.particle_areas()[particle] > 1.3 * plain;
        assert!(!is_heavy || at.x < -0.2, "{at} is no bone");
    }
    let added = made.fabric.mass_area() - made.fabric.area();
    assert!((added / (8.0 * 0.02 * 0.6) - 1.0).abs() < 0.1, "{added}");
}

/// Area of most particles, m².
fn skirt_areas(fabric: &Fabric) -> f32 {
    let mut areas = fabric.particle_areas().to_vec();
    areas.sort_by(f32::total_cmp);
    areas[areas.len() / 2]
}
