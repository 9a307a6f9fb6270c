//! Tests of pinned cloth that shapes would strain too far: they pass through it.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion,
    Grid, LaneCount, LinkFamily, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use crate::common::longest_link;

const TICK: f32 = 1.0 / 60.0;
/// Particles of a row and of a column.
const SIZE: usize = 17;
/// Speed of the post, m/s.
const SPEED: f32 = 10.0;

/// A sheet of a square metre that is held at its left side, or at both.
fn sheet(both: bool) -> (Arc<Fabric>, ClothBatch) {
    sheet_of(both, FabricMaterial::COTTON)
}

fn sheet_of(both: bool, material: FabricMaterial) -> (Arc<Fabric>, ClothBatch) {
    let grid = FabricBuilder::grid(Grid::new(SIZE as u32, SIZE as u32, 1.0, 1.0));
    let held = grid.pin_where(|_, uv| uv.x == 0.0 || both && uv.x == 1.0);
    let fabric = Arc::new(held.build().expect("a good fabric"));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    let material =
        FabricMaterial { damping: 4.0, thickness: 2e-3, surface_friction: 0.5, ..material };
    let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("a free lane");
    // The sheet lies in the xy plane.
    let fall = Drive { gravity: Vec3::new(0.0, 0.0, -9.81), ..Drive::default() };
    batch.drive(lane, fall).expect("a good drive");
    (fabric, batch)
}

/// Greatest length of a link, in lengths at rest.
fn longest(fabric: &Fabric, batch: &ClothBatch) -> f32 {
    longest_link(fabric, &batch.snapshot(0).positions)
}

fn fastest(batch: &ClothBatch) -> f32 {
    batch.snapshot(0).velocities.iter().map(|it| it.length()).fold(0.0, f32::max)
}

/// A post that rises through the middle of a sheet until a tick.
fn post(tick: u32, last: u32) -> Collider {
    let at = |tick: u32| Vec3::new(0.5, -0.5, SPEED * TICK * tick.min(last) as f32 - 0.2);
    let [from, to] = [tick, tick + 1].map(|tick| (at(tick), Quat::IDENTITY));
    let still = Collider::fixed(SharedShape::capsule_y(2.0, 0.05), Vec3::ZERO, Quat::IDENTITY);
    Collider { from, to, ..still }
}

/// It draws the sheet out to one and a half times its length, passes, and the sheet hangs as before.
#[test]
fn a_post_that_would_tear_cloth_passes_through_it() {
    let (fabric, mut batch) = sheet(true);
    let mut drawn_out = 0.0_f32;
    for tick in 0..120 {
        batch.set_colliders(0, [post(tick, 120)]).expect("a good shape");
        batch.step(TICK, StepSettings::default());
        drawn_out = drawn_out.max(longest(&fabric, &batch));
    }
    // A shape that moves draws a link out by four times its way, 1.3 m.
    assert!((2.0..25.0).contains(&drawn_out), "{drawn_out}");
    (0..120).for_each(|_| batch.step(TICK, StepSettings::default()));
    assert!(longest(&fabric, &batch) < 1.05, "{}", longest(&fabric, &batch));
}

/// It stops where the sheet is drawn out to 1.4 times its length: less than that from which on shapes pass through.
#[test]
fn a_post_that_stops_in_drawn_out_cloth_passes_through_it() {
    const LAST: u32 = 4;
    let (fabric, mut batch) = sheet(true);
    for tick in 0..240 {
        batch.set_colliders(0, [post(tick, LAST)]).expect("a good shape");
        batch.step(TICK, StepSettings::default());
        if tick + 1 == LAST {
            assert!(longest(&fabric, &batch) > 4.0, "{}", longest(&fabric, &batch));
        }
    }
    assert!(longest(&fabric, &batch) < 1.2, "{}", longest(&fabric, &batch));
    assert!(fastest(&batch) < 0.1, "{} m/s", fastest(&batch));
}

/// The pole is so thick that two columns of particles have no place outside.
#[test]
fn cloth_with_its_pins_within_a_pole_comes_to_rest_unstretched() {
    let (fabric, mut batch) = sheet(false);
    let pole = SharedShape::capsule_y(2.0, 0.15);
    let pole = Collider::fixed(pole, Vec3::new(0.0, -0.5, 0.0), Quat::IDENTITY);
    batch.set_colliders(0, [pole]).expect("a good shape");
    (0..300).for_each(|_| batch.step(TICK, StepSettings::default()));
    assert!(longest(&fabric, &batch) < 1.1, "{}", longest(&fabric, &batch));
    assert!(fastest(&batch) < 0.02, "{} m/s", fastest(&batch));
}

/// Its diagonals are as long as they are drawn, and say nothing about how far its particles may be from their pins.
#[test]
fn limp_cloth_with_its_pins_within_a_pole_comes_to_rest_unstretched() {
    let limp = FabricMaterial { shear_stiffness: 0.0, ..FabricMaterial::COTTON };
    let (fabric, mut batch) = sheet_of(false, limp);
    let pole = SharedShape::capsule_y(2.0, 0.15);
    let pole = Collider::fixed(pole, Vec3::new(0.0, -0.5, 0.0), Quat::IDENTITY);
    batch.set_colliders(0, [pole]).expect("a good shape");
    (0..300).for_each(|_| batch.step(TICK, StepSettings::default()));
    let positions = batch.snapshot(0).positions;
    let straight = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    let longest = straight.map(|link| {
        let [from, to] = link.particles.map(|end| positions[end as usize]);
        from.distance(to) / link.rest_length
    });
    let longest = longest.fold(0.0, f32::max);
    assert!(longest < 1.1, "{longest}");
}

/// Ticks at 12 substeps, with a collider in each.
fn step_with(batch: &mut ClothBatch, collider: Collider) {
    batch.set_colliders(0, [collider]).expect("a good shape");
    batch.step(TICK, StepSettings { substeps: 12, ..StepSettings::default() });
}

/// A curtain of 2 m and 33 × 33 particles in the xy plane, which hangs from its top.
fn curtain() -> (Arc<Fabric>, ClothBatch) {
    let grid = FabricBuilder::grid(Grid::new(33, 33, 2.0, 2.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good fabric"));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::COTTON);
    let fall = Drive { gravity: Vec3::new(0.0, -9.81, 0.0), ..Drive::default() };
    batch.drive(lane.expect("a free lane"), fall).expect("a good drive");
    (fabric, batch)
}

/// Its lines draw the curtain tight over the ball, and its particles must not stick there.
#[test]
fn a_curtain_slips_off_a_ball_that_runs_through_it() {
    const RUN: f32 = 3.0;
    let (fabric, mut batch) = curtain();
    let mut stretched = 0.0_f32;
    for tick in 0..56 {
        let at = |tick: u32| Vec3::new(1.2, -1.2, RUN * TICK * tick as f32 - 0.3);
        let [from, to] = [tick, tick + 1].map(|tick| (at(tick), Quat::IDENTITY));
        let still = Collider::fixed(SharedShape::ball(0.11), Vec3::ZERO, Quat::IDENTITY);
        step_with(&mut batch, Collider { from, to, ..still });
        stretched = stretched.max(longest(&fabric, &batch));
    }
    assert!(stretched < 1.3, "{stretched}");
}

/// Half a second later no link is strained by more than shapes may strain it.
#[test]
fn a_leg_that_pierces_a_cape_at_its_start_does_not_draw_it_out() {
    let grid = FabricBuilder::grid(Grid::new(17, 25, 0.5, 1.1));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good fabric"));
    for stride in [0.3, 0.4, 0.5, 0.6, 0.7] {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::COTTON);
        let fall = Drive { gravity: Vec3::new(0.0, -9.81, 0.0), ..Drive::default() };
        batch.drive(lane.expect("a free lane"), fall).expect("a good drive");
        let turn = Quat::from_rotation_x(-stride);
        let hip = Vec3::new(0.35, -0.57, -0.2);
        let leg = SharedShape::capsule_y(0.35, 0.1);
        let leg = Collider::fixed(leg, hip + turn * Vec3::new(0.0, -0.44, 0.0), turn);
        (0..30).for_each(|_| step_with(&mut batch, leg.clone()));
        let stretched = longest(&fabric, &batch);
        assert!(stretched < 1.2, "stride {stride}: {stretched}");
    }
}

/// The load of a ball of 0.1 m that moves at a velocity, m/s, towards a curtain in a frame of a velocity, m/s, and starts at a distance, m.
fn load_of_approach(velocity: f32, of_frame: f32, distance: f32) -> f32 {
    let (_, mut batch) = curtain();
    let motion = FrameMotion { translation: of_frame * TICK * Vec3::Z, ..FrameMotion::default() };
    batch.drive(0, Drive { motion, ..Drive::default() }).expect("a good drive");
    // Poses are in the frame of their time.
    let at = |way: f32| (Vec3::new(1.0, -1.0, way - distance - 0.1), Quat::IDENTITY);
    let still = Collider::fixed(SharedShape::ball(0.1), Vec3::ZERO, Quat::IDENTITY);
    let (from, to) = (at(0.0), at((velocity - of_frame) * TICK));
    step_with(&mut batch, Collider { from, to, ..still });
    batch.contact_load(0)
}

/// Its way in a tick is two and a half links long, of which it must pass at most a part in a substep.
#[test]
fn a_fast_collider_near_held_cloth_is_a_load_before_it_hits() {
    let load = load_of_approach(10.0, 0.0, 0.2);
    assert!((load / 1667.0 - 1.0).abs() < 0.01, "{load}");
    assert_eq!(load_of_approach(10.0, 0.0, 1.0), 0.0);
    // In front of the curtain, which it does not touch.
    assert_eq!(load_of_approach(10.0, 10.0, -0.4), 0.0);
}
