//! Item 5: a clone of a cloth is independent and starts in the same state.

use bevy_bunting::prelude::*;
use bevy_math::Vec3;
use bunting_tests::{app, assert_finite, bits, run, spawn_flag};

#[test]
fn a_clone_is_simulated_independently() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 2.0)));
    let original = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 60);
    let clone = app.world_mut().entity_mut(original).clone_and_spawn();
    assert_eq!(bits(&app, clone), bits(&app, original));
    for tick in 0..30 {
        app.update();
        assert_eq!(bits(&app, clone), bits(&app, original), "tick {tick}");
    }
    app.world_mut().despawn(original);
    let before = bits(&app, clone);
    run(&mut app, 30);
    assert_finite(&app, clone);
    assert_ne!(bits(&app, clone), before, "it stands still");
}

#[test]
fn a_clone_of_a_sleeping_or_paused_cloth_is_independent() {
    let mut app = app();
    let original = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 20);
    app.world_mut().entity_mut(original).insert(ClothPaused);
    run(&mut app, 2);
    let clone = app.world_mut().entity_mut(original).clone_and_spawn();
    app.world_mut().entity_mut(clone).remove::<ClothPaused>();
    let paused = bits(&app, original);
    run(&mut app, 20);
    assert_eq!(bits(&app, original), paused);
    assert_ne!(bits(&app, clone), paused);
    app.world_mut().despawn(original);
    run(&mut app, 2);
    assert_finite(&app, clone);
}
