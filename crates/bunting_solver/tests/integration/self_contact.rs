//! Tests of contacts of a cloth with itself.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial,
    FrameMotion, Grid, LaneCount, SelfCollision, StepSettings, has_fused_products,
    with_every_instruction_set,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

const TICK: f32 = 1.0 / 60.0;
const SETTINGS: StepSettings = StepSettings { passes: 2, ..StepSettings::yarns(2) };
/// Distance of layers, m.
const THICKNESS: f32 = 5e-3;
/// Columns and rows.
const SIZE: usize = 17;
/// Distance of columns, m.
const SPACING: f32 = 0.5 / 16.0;

/// A free sheet of half a metre.
fn sheet() -> Arc<Fabric> {
    let grid = Grid::new(SIZE as u32, SIZE as u32, 0.5, 0.5);
    Arc::new(FabricBuilder::grid(grid).build().expect("a good fabric"))
}

/// The sheet folded along a column: left of it in the plane y = 0, right of it above that at `height(column)`, m.
fn folded(fabric: &Fabric, height: impl Fn(usize) -> f32) -> ClothSnapshot {
    let mut start = ClothSnapshot::at_rest(fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        let (column, row) = (particle % SIZE, particle / SIZE);
        let along = if column <= SIZE / 2 { column } else { SIZE - 1 - column };
        // The layers are not exactly above each other.
        let aside = if column <= SIZE / 2 { 0.0 } else { 0.3 * SPACING };
        let height = if column <= SIZE / 2 { 0.0 } else { height(column) };
        *at = Vec3::new(along as f32 * SPACING + aside, height, row as f32 * SPACING + aside);
    }
    start
}

fn batch_of(
    fabric: &Arc<Fabric>,
    start: &ClothSnapshot,
    lanes: LaneCount,
    settings: Option<SelfCollision>,
) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let material = FabricMaterial { thickness: 1e-3, ..FabricMaterial::COTTON };
    let lane = batch.insert(start, material).expect("a good cloth");
    batch.set_self_collision(lane, settings).expect("a good thickness");
    batch
}

fn positions(batch: &ClothBatch) -> Vec<Vec3> {
    let mut positions = Vec::new();
    batch.copy_positions(0, &mut positions);
    positions
}

/// Lets the upper half of a sheet fall on the lower one, on a floor.
fn fall(lanes: LaneCount, settings: Option<SelfCollision>) -> Vec<Vec3> {
    let fabric = sheet();
    let start = folded(&fabric, |_| 0.05);
    let mut batch = batch_of(&fabric, &start, lanes, settings);
    let floor = SharedShape::halfspace(Vec3::Y);
    let floor = Collider::fixed(floor, -1e-3 * Vec3::Y, Quat::IDENTITY);
    batch.set_colliders(0, [floor]).expect("a good floor");
    for _ in 0..90 {
        batch.step(TICK, SETTINGS);
    }
    positions(&batch)
}

/// Median height of the upper layer, m, two columns and more from the fold.
fn upper_height(positions: &[Vec3]) -> f32 {
    let upper = positions.iter().enumerate().filter(|(particle, _)| particle % SIZE > SIZE / 2 + 2);
    let mut heights: Vec<f32> = upper.map(|(_, at)| at.y).collect();
    heights.sort_by(f32::total_cmp);
    heights[heights.len() / 2]
}

const APART: Option<SelfCollision> = Some(SelfCollision { thickness: THICKNESS });

#[test]
fn a_layer_comes_to_rest_on_another() {
    let (apart, free) =
        (upper_height(&fall(LaneCount::One, APART)), upper_height(&fall(LaneCount::One, None)));
    assert!((0.7 * THICKNESS..1.3 * THICKNESS).contains(&apart), "{apart}");
    assert!(free < 0.2 * THICKNESS, "{free}");
}

#[test]
fn layers_have_the_same_bits_at_every_width() {
    let bits = |lanes| -> Vec<[u32; 3]> {
        fall(lanes, APART).iter().map(|at| at.to_array().map(f32::to_bits)).collect()
    };
    let one = bits(LaneCount::One);
    for &lanes in LaneCount::available() {
        assert_eq!(bits(lanes), one, "{lanes:?}");
    }
}

#[test]
fn layers_have_the_same_bits_with_every_instruction_set_that_fuses() {
    let bits = || -> Vec<[u32; 3]> {
        fall(LaneCount::One, APART).iter().map(|at| at.to_array().map(f32::to_bits)).collect()
    };
    let runs = with_every_instruction_set(|| has_fused_products().then(bits));
    let runs: Vec<_> = runs.into_iter().flatten().collect();
    assert!(runs.iter().all(|run| *run == runs[0]));
}

/// Number of links of the upper layer through the lower one, which is held in the plane y = 0.
fn links_through_lower(fabric: &Fabric, positions: &[Vec3]) -> usize {
    let passes = |[a, b]: [Vec3; 2]| {
        let at = a.lerp(b, a.y / (a.y - b.y));
        let inside = |value: f32, greatest: f32| (0.0..greatest).contains(&value);
        a.y * b.y < 0.0 && inside(at.x, 8.0 * SPACING) && inside(at.z, 16.0 * SPACING)
    };
    let links = fabric.links().iter().map(|link| link.particles.map(|it| positions[it as usize]));
    links.filter(|&ends| passes(ends)).count()
}

#[test]
fn layers_that_start_tangled_come_apart() {
    // The lower layer is held. The free edge of the upper one passes through it.
    const HEIGHTS: [f32; 8] = [0.015, 0.03, 0.03, 0.03, 0.02, 0.01, 0.002, -0.01];
    let grid = FabricBuilder::grid(Grid::new(SIZE as u32, SIZE as u32, 0.5, 0.5));
    let fabric = grid.pin_where(|_, uv| uv.x < 0.52).build().expect("a good fabric");
    let fabric = Arc::new(fabric);
    let start = folded(&fabric, |column| HEIGHTS[column - SIZE / 2 - 1]);
    let fly = |settings| {
        let mut batch = batch_of(&fabric, &start, LaneCount::One, settings);
        (0..180).for_each(|_| batch.step(TICK, SETTINGS));
        let mut velocities = Vec::new();
        batch.copy_velocities(0, &mut velocities);
        let fastest = velocities.iter().map(|it| it.length()).fold(0.0, f32::max);
        let positions = positions(&batch);
        (links_through_lower(&fabric, &positions), upper_height(&positions), fastest)
    };
    assert!(links_through_lower(&fabric, &start.positions) > 20);
    let (links, height, fastest) = fly(APART);
    assert!(links == 0 && height > 0.0, "{links} links through it, {height} m above");
    assert!(fastest < 0.5, "{fastest} m/s");
    let (_, height, _) = fly(None);
    assert!(height < 0.0, "{height} m above without contacts");
}

/// Layers held at one side touch as they do at rest while their frame moves evenly.
#[test]
fn layers_of_cloth_on_a_vehicle_touch_as_at_rest() {
    let grid = FabricBuilder::grid(Grid::new(SIZE as u32, SIZE as u32, 0.5, 0.5));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good fabric"));
    let start = folded(&fabric, |_| 2.0 * THICKNESS);
    let swing = |velocity: Vec3| {
        let mut start = start.clone();
        start.velocities.iter_mut().for_each(|it| *it = velocity);
        let mut batch = batch_of(&fabric, &start, LaneCount::One, APART);
        let motion = FrameMotion { translation: velocity * TICK, ..FrameMotion::NONE };
        for _ in 0..20 {
            let drive = Drive { motion, air_density: 0.0, ..Drive::default() };
            batch.drive(0, drive).expect("a good drive");
            batch.step(TICK, SETTINGS);
        }
        positions(&batch)
    };
    let (at_rest, moving) = (swing(Vec3::ZERO), swing(Vec3::new(20.0, 5.0, 10.0)));
    let apart = |(one, other): (&Vec3, &Vec3)| one.distance(*other);
    let farthest = at_rest.iter().zip(&moving).map(apart).fold(0.0, f32::max);
    assert!(farthest < 1e-3, "{farthest} m apart");
}

#[test]
fn a_thickness_must_be_finite_and_greater_than_zero() {
    let fabric = sheet();
    let mut batch = batch_of(&fabric, &ClothSnapshot::at_rest(&fabric), LaneCount::One, None);
    for thickness in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let result = batch.set_self_collision(0, Some(SelfCollision { thickness }));
        assert_eq!(result, Err(BatchError::SelfCollision), "{thickness}");
    }
}
