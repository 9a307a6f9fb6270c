//! Item 7: a change of attachment does not whip the cloth. Item 11: targets that are spawned later or
//! replaced.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, bits, greatest_speed, run, spawn_flag, state};

use super::strain;

/// Greatest strain that a change of attachment may cause.
const STRAIN: f32 = 0.1;

/// Greatest speed in the cloth's frame that a change of attachment may cause, m/s: free cloth reaches half of
/// it in half a second.
const SPEED: f32 = 12.0;

/// Greatest strain and speed (m/s) in the two seconds after a change.
fn worst(app: &mut App, flag: Entity) -> (f32, f32) {
    let each = (0..128).map(|_| {
        app.update();
        (strain(app, flag).greatest, greatest_speed(app, flag))
    });
    each.fold((0.0, 0.0), |(a, b), (c, d)| (f32::max(a, c), f32::max(b, d)))
}

fn assert_no_whip(app: &mut App, flag: Entity) {
    let (strain, speed) = worst(app, flag);
    assert!(strain < STRAIN, "strain {strain}, {speed} m/s");
    assert!(speed < SPEED, "{speed} m/s");
    let state = state(app, flag);
    let fabric = state.fabric().expect("a fabric");
    for particle in (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle)) {
        assert_eq!(state.positions()[particle], fabric.rest_positions()[particle], "held at last");
    }
}

fn edit(app: &mut App, flag: Entity, edit: impl FnOnce(&mut Attachment)) {
    edit(&mut app.world_mut().get_mut::<Attachment>(flag).expect("attached"));
}

fn hung() -> (App, Entity) {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(0.5, 0.0, 1.0)));
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 64 * 4);
    (app, flag)
}

#[test]
fn a_newly_attached_edge_moves_gently() {
    let (mut app, flag) = hung();
    edit(&mut app, flag, |held| held.vertices = ClothEdge::Top.into());
    assert_no_whip(&mut app, flag);
}

#[test]
fn cloth_is_attached_gently_from_metres_away() {
    for (ticks, distance) in [(24, 1.0), (28, 5.0), (36, 40.0)] {
        let mut app = app();
        let cloth = app.world_mut().spawn((FLAG, Transform::default())).id();
        run(&mut app, ticks);
        let pole = app.world_mut().spawn(Transform::from_xyz(distance, 0.0, 0.0)).id();
        app.world_mut().entity_mut(cloth).insert(Attachment::new(pole, ClothEdge::Left));
        assert_no_whip(&mut app, cloth);
    }
}

#[test]
fn falling_cloth_is_caught_gently() {
    for ticks in [80, 96, 128] {
        let (mut app, flag) = hung();
        let held = app.world().get::<Attachment>(flag).expect("attached").clone();
        app.world_mut().entity_mut(flag).remove::<Attachment>();
        run(&mut app, ticks);
        app.world_mut().entity_mut(flag).insert(held);
        assert_no_whip(&mut app, flag);
    }
}

#[test]
fn another_target_carries_the_cloth_along() {
    let (mut app, flag) = hung();
    let pole = app.world_mut().spawn(Transform::from_xyz(7.0, 2.0, 0.0)).id();
    edit(&mut app, flag, |held| held.target = pole);
    assert_no_whip(&mut app, flag);
}

#[test]
fn another_offset_carries_the_cloth_along() {
    for by in [0.1, 0.2, 0.38, 0.5, 3.0] {
        let mut app = app();
        let pole = app.world_mut().spawn(Transform::default()).id();
        let flag = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
        run(&mut app, 128);
        edit(&mut app, flag, |held| held.offset.translation.z += by);
        assert_no_whip(&mut app, flag);
    }
}

#[test]
fn a_target_may_get_its_transform_later() {
    let mut app = app();
    let pole = app.world_mut().spawn_empty().id();
    let flag = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
    run(&mut app, 10);
    let failures = app.world().resource::<Seen<ClothFailed>>().0.len();
    assert_eq!(failures, 1, "told once");
    app.world_mut().entity_mut(pole).insert(Transform::from_xyz(1.0, 2.0, 3.0));
    run(&mut app, 3);
    assert!(!state(&app, flag).positions().is_empty(), "it is not simulated");
}

#[test]
fn a_new_target_ends_the_freeze() {
    let mut app = app();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let flag = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
    run(&mut app, 10);
    app.world_mut().despawn(pole);
    run(&mut app, 10);
    assert!(app.world().get::<ClothPaused>(flag).is_some());
    let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 1.0, 0.0)).id();
    edit(&mut app, flag, |held| held.target = pole);
    run(&mut app, 2);
    let before = bits(&app, flag);
    run(&mut app, 10);
    assert!(app.world().get::<ClothPaused>(flag).is_none());
    assert_ne!(bits(&app, flag), before);
}
