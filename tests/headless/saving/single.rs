//! Single cloths are saved and restored among others.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{app, bits, run, spawn_flag, state};

#[test]
fn one_of_two_cloths_goes_back_and_the_other_goes_on() {
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().share_batches = false;
    app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)));
    let flags = [spawn_flag(&mut app, Vec3::ZERO), spawn_flag(&mut app, Vec3::X)];
    run(&mut app, 40);
    let snapshot = app.world().save_cloth(flags[0]).expect("a flag");
    assert_eq!(snapshot.positions(), state(&app, flags[0]).positions());
    let saved = bits(&app, flags[0]);
    run(&mut app, 10);
    let [expected, other] = flags.map(|flag| bits(&app, flag));
    assert_ne!(expected, saved);
    app.world_mut().restore_cloth(flags[0], &snapshot).expect("it fits");
    assert_eq!(bits(&app, flags[0]), saved, "what is read is restored at once");
    assert_eq!(bits(&app, flags[1]), other);
    run(&mut app, 10);
    assert_eq!(bits(&app, flags[0]), expected);
    let mut alone = self::app();
    alone.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)));
    let lone = spawn_flag(&mut alone, Vec3::X);
    run(&mut alone, 60);
    assert_eq!(bits(&app, flags[1]), bits(&alone, lone), "the other one went on");
}

#[test]
fn a_snapshot_is_restored_to_a_cloth_that_was_never_simulated() {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 40);
    let snapshot = app.world().save_cloth(flag).expect("a flag");
    let shape = bits(&app, flag);
    let new = spawn_flag(&mut app, Vec3::ZERO);
    app.world_mut().restore_cloth(new, &snapshot).expect("it fits");
    assert_eq!(bits(&app, new), shape, "it is shown at once");
    assert_eq!(state(&app, new).activity(), ClothActivity::Ticking);
    run(&mut app, 30);
    assert_eq!(bits(&app, new), bits(&app, flag), "both go on alike");
}

#[test]
fn a_paused_cloth_keeps_its_state_and_a_caught_one_comes_off_again() {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 30);
    app.world_mut().entity_mut(flag).insert(ClothPaused);
    run(&mut app, 5);
    let snapshot = app.world().save_cloth(flag).expect("a flag");
    let shape = bits(&app, flag);
    // It is held elsewhere and goes on in other places.
    app.world_mut().entity_mut(flag).remove::<ClothPaused>();
    app.world_mut().entity_mut(flag).insert(Attachment::in_place(ClothEdge::Top));
    run(&mut app, 30);
    assert_ne!(bits(&app, flag), shape);
    let held = (Attachment::in_place(ClothEdge::Left), ClothPaused);
    app.world_mut().entity_mut(flag).insert(held);
    app.world_mut().restore_cloth(flag, &snapshot).expect("it fits");
    run(&mut app, 10);
    assert_eq!(bits(&app, flag), shape);
    app.world_mut().entity_mut(flag).remove::<ClothPaused>();
    run(&mut app, 10);
    assert_ne!(bits(&app, flag), shape);
    let pole = app.world().get::<Transform>(flag).expect("a transform").translation;
    assert_eq!(pole, Vec3::ZERO);
}

#[test]
fn a_cloth_takes_the_substeps_that_other_settings_ask_for() {
    let steps = |app: &App, flag: Entity| {
        app.world().get::<bevy_bunting::ClothEffort>(flag).expect("a cloth").settings().substeps
    };
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 30);
    let snapshot = app.world().save_cloth(flag).expect("a flag");
    let mut other = self::app();
    let more = StepLimits { substeps: 6..=6, ..StepLimits::default() };
    other.world_mut().resource_mut::<ClothSettings>().steps = vec![more];
    let there = spawn_flag(&mut other, Vec3::ZERO);
    run(&mut other, 2);
    other.world_mut().restore_cloth(there, &snapshot).expect("it fits");
    run(&mut other, 2);
    assert!(steps(&app, flag) < 6);
    assert_eq!(steps(&other, there), 6);
}

#[test]
fn reactions_that_were_asked_for_later_are_none_in_the_past() {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    let ball = (ClothCollider::ball(0.2), Transform::from_xyz(-0.1, -0.4, 0.1));
    let ball = app.world_mut().spawn(ball).id();
    run(&mut app, 30);
    let snapshot = app.world().save_cloths().expect("it can be saved");
    app.world_mut().entity_mut(flag).insert(AnchorReactions::default());
    app.world_mut().entity_mut(ball).insert(ClothReactions::default());
    run(&mut app, 10);
    let force = |app: &App| {
        let of_anchor = app.world().get::<AnchorReactions>(flag).expect("asked for").target.force;
        (of_anchor, app.world().get::<ClothReactions>(ball).expect("asked for").force)
    };
    let (of_anchor, of_ball) = force(&app);
    assert!(of_anchor != Vec3::ZERO && of_ball != Vec3::ZERO, "{of_anchor} {of_ball}");
    app.world_mut().restore_cloths(&snapshot).expect("it fits");
    assert_eq!(force(&app), (Vec3::ZERO, Vec3::ZERO));
}
