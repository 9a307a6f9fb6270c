//! Tests of pinned cloth that shapes would tear: they pass through it.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    LaneCount, LinkFamily, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

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
    let positions = batch.snapshot(0).positions;
    let length = |[from, to]: [u32; 2]| positions[from as usize].distance(positions[to as usize]);
    let lengths = fabric.links().iter().map(|link| length(link.particles) / link.rest_length);
    lengths.fold(0.0, f32::max)
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

/// It draws the sheet out to three times its length, passes, and the sheet hangs as before.
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
