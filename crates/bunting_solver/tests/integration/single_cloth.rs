//! Tests that a batch of one cloth, whose own yarns fill the lanes, computes the same bits as a batch of
//! several cloths.

use std::sync::Arc;

use crate::common::{irregular, net};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion,
    Grid, LaneCount, StepSettings, with_every_instruction_set,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

const TICK: f32 = 1.0 / 60.0;

fn yarns(substeps: u32, passes: u32) -> StepSettings {
    StepSettings { passes, ..StepSettings::yarns(substeps) }
}

/// A changing wind, and a frame that moves for a while.
fn drive(tick: usize) -> Drive {
    let time = tick as f32 * TICK;
    let motion = if (40..90).contains(&tick) {
        FrameMotion {
            rotation: Quat::from_rotation_y(0.01),
            translation: Vec3::new(0.02, 0.0, -0.01),
        }
    } else {
        FrameMotion::NONE
    };
    let wind = Vec3::new(6.0, 0.3, 4.0 * libm::sinf(7.0 * time));
    Drive { motion, wind, ..Drive::default() }
}

fn fly(
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    material: FabricMaterial,
    settings: StepSettings,
) -> Vec<u32> {
    let mut batch = ClothBatch::new(fabric.clone(), lanes);
    let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("a free lane");
    let ball = Collider {
        features: true,
        ..Collider::fixed(SharedShape::ball(0.2), Vec3::new(0.5, -0.5, 0.3), Quat::IDENTITY)
    };
    batch.set_colliders(lane, [ball]).expect("good shapes");
    let mut normals = Vec::new();
    for tick in 0..200 {
        batch.drive(lane, drive(tick)).expect("a good drive");
        // A cloth that is removed and put back continues with the same bits.
        if tick == 100 {
            let moving = batch.snapshot(lane);
            batch.restore(lane, &moving).expect("its own state");
        }
        batch.step(TICK, settings);
    }
    batch.copy_normals(lane, &mut normals);
    let ClothSnapshot { positions, velocities, .. } = batch.snapshot(lane);
    assert!(batch.is_finite(lane));
    let vectors = positions.iter().chain(&velocities).chain(&normals);
    vectors.flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
}

fn agrees(grid: FabricBuilder, material: FabricMaterial, settings: StepSettings) {
    agree(&Arc::new(grid.build().expect("a good fabric")), material, settings);
}

fn agree(fabric: &Arc<Fabric>, material: FabricMaterial, settings: StepSettings) {
    let alone = fly(fabric, LaneCount::One, material, settings);
    let shared = fly(fabric, LaneCount::Eight, material, settings);
    let first = alone.iter().zip(&shared).position(|(alone, shared)| alone != shared);
    assert_eq!(first, None, "{} particles, {settings:?}", fabric.particle_count());
}

#[test]
fn flags_of_any_size_agree() {
    for (columns, rows) in [(33, 33), (17, 9), (5, 23), (8, 16), (2, 9), (9, 2)] {
        for settings in [yarns(1, 4), yarns(2, 2), yarns(3, 1)] {
            let (width, height) = (0.05 * (columns - 1) as f32, 0.04 * (rows - 1) as f32);
            let grid = FabricBuilder::grid(Grid::new(columns, rows, width, height));
            agrees(grid.pin_where(|_, uv| uv.x == 0.0), FabricMaterial::SILK, settings);
        }
    }
}

#[test]
fn pins_anywhere_agree() {
    let grid = || FabricBuilder::grid(Grid::new(13, 11, 1.0, 1.0));
    let stiff = FabricMaterial { bend_stiffness: 10.0, ..FabricMaterial::DENIM };
    let damped = FabricMaterial { internal_damping: 1.0, ..FabricMaterial::COTTON };
    for material in [FabricMaterial::FLAG_POLYESTER, stiff, damped] {
        agrees(grid(), material, yarns(2, 2));
        agrees(grid().pin([0, 12]), material, yarns(2, 2));
        agrees(grid().pin_where(|_, uv| uv.y == 0.0), material, yarns(2, 2));
        // The pins are a hole in the middle of rows, columns and diagonals.
        agrees(grid().pin([57, 58, 59, 70, 71, 72, 84, 86]), material, yarns(2, 2));
    }
}

#[test]
fn grids_of_long_cells_agree() {
    let grid = FabricBuilder::grid(Grid::new(5, 17, 2.0, 0.5));
    agrees(grid.pin_where(|_, uv| uv.x == 0.0), FabricMaterial::COTTON, yarns(2, 2));
}

/// Irregular triangles over the unit square, moved to other places at the same heights, hung from the top.
fn mesh(place: impl Fn(Vec3) -> Vec3) -> Arc<Fabric> {
    let flat = irregular(17, 0.0);
    let positions = flat.positions().iter().map(|&at| place(at)).collect();
    let mesh = FabricBuilder::new(positions, flat.indices().to_vec());
    net(&mesh.weld_distance(1e-5).pin_where(|at, _| at.y == 0.0))
}

#[test]
fn meshes_agree() {
    let rolled = |radius: f32, at: Vec3| {
        let angle = at.x * core::f32::consts::TAU;
        Vec3::new(radius * libm::sinf(angle), at.y, radius * libm::cosf(angle))
    };
    agree(&mesh(|at| at), FabricMaterial::COTTON, yarns(2, 2));
    agree(&mesh(|at| rolled(0.2, at)), FabricMaterial::COTTON, yarns(2, 2));
    // Each cell has diagonals of its own.
    let narrow = |at: Vec3| at * Vec3::new(1.0 + 0.4 * at.y, 1.0, 1.0);
    agree(&mesh(narrow), FabricMaterial::COTTON, yarns(2, 2));
    agree(&mesh(|at| rolled(0.2 + 0.1 * at.y, at)), FabricMaterial::SILK, yarns(3, 2));
}

#[test]
fn layouts_agree_with_every_instruction_set() {
    with_every_instruction_set(|| {
        let grid = FabricBuilder::grid(Grid::new(9, 7, 1.2, 0.8)).pin_where(|_, uv| uv.x == 0.0);
        agrees(grid, FabricMaterial::SILK, yarns(2, 2));
    });
}

#[test]
fn a_lane_that_was_not_finite_can_be_used_again() {
    let grid = FabricBuilder::grid(Grid::new(9, 7, 1.2, 0.8)).pin_where(|_, uv| uv.x == 0.0);
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let rest = ClothSnapshot::at_rest(&fabric);
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    batch.insert(&rest, FabricMaterial::SILK).expect("a free lane");
    batch
        .drive(0, Drive { wind: Vec3::splat(f32::MAX), ..Drive::default() })
        .expect("a good drive");
    batch.step(TICK, yarns(2, 2));
    assert!(!batch.is_finite(0));
    batch.restore(0, &rest).expect("a good state");
    batch.drive(0, Drive::default()).expect("a good drive");
    (0..10).for_each(|_| batch.step(TICK, yarns(2, 2)));
    assert!(batch.is_finite(0));
}

#[test]
fn a_change_of_scheme_between_ticks_agrees() {
    let grid = FabricBuilder::grid(Grid::new(9, 7, 1.2, 0.8)).pin_where(|_, uv| uv.x == 0.0);
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let [alone, shared] = [LaneCount::One, LaneCount::Eight].map(|lanes| {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::SILK).expect("a free lane");
        for tick in 0..90 {
            batch.drive(0, drive(tick)).expect("a good drive");
            let sweeps = (30..60).contains(&tick);
            batch.step(TICK, if sweeps { StepSettings::gauss_seidel(5) } else { yarns(2, 2) });
        }
        batch.snapshot(0)
    });
    assert_eq!(alone, shared);
}

#[test]
fn pins_too_far_apart_agree() {
    let grid = FabricBuilder::grid(Grid::new(13, 11, 1.0, 1.0)).pin([0, 12, 136]);
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let mut wide = ClothSnapshot::at_rest(&fabric);
    wide.positions.iter_mut().for_each(|position| *position *= 1.05);
    let [alone, shared] = [LaneCount::One, LaneCount::Eight].map(|lanes| {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        // The batch holds a second cloth, at rest.
        if lanes != LaneCount::One {
            let rest = ClothSnapshot::at_rest(&fabric);
            batch.insert(&rest, FabricMaterial::DENIM).expect("a free lane");
        }
        let lane = batch.insert(&wide, FabricMaterial::SILK).expect("a free lane");
        for tick in 0..90 {
            batch.drive(lane, drive(tick)).expect("a good drive");
            batch.step(TICK, yarns(2, 2));
        }
        batch.snapshot(lane)
    });
    assert_eq!(alone, shared);
}
