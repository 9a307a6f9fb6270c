//! Bodies feel contacts and anchors when they ask to.

use avian3d::prelude::*;
use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::FeelsCloth;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{run, state};

use crate::{SECOND, app, places, position, sheet};

/// Gravity, m/s².
const GRAVITY: f32 = 9.81;

/// A sheet held by two edges, and a ball that falls on it from 0.3 m above.
fn ball_on_sheet(feels: Option<FeelsCloth>) -> (App, Entity) {
    let mut app = app();
    let cloth = app.world_mut().spawn(sheet(0.0)).id();
    let post = app.world_mut().spawn(sheet(0.0).1).id();
    let held = Attachment::in_place(ClothEdge::Left);
    let held = held.with_anchor(Anchor::new(post, ClothEdge::Right));
    app.world_mut().entity_mut(cloth).insert(held);
    let ball = (RigidBody::Dynamic, Collider::sphere(0.2), Mass(0.2));
    let ball = app.world_mut().spawn((ball, Transform::from_xyz(0.0, 0.5, 0.0))).id();
    if let Some(feels) = feels {
        app.world_mut().entity_mut(ball).insert(feels);
    }
    (app, ball)
}

fn velocity(app: &App, body: Entity) -> Vec3 {
    app.world().get::<LinearVelocity>(body).expect("a body").0
}

#[test]
fn a_ball_is_carried_by_a_sheet_if_it_feels_it() {
    let (mut app, ball) = ball_on_sheet(Some(FeelsCloth::default()));
    run(&mut app, SECOND);
    for tick in 0..3 * SECOND {
        app.update();
        let (at, speed) = (position(&app, ball), velocity(&app, ball).length());
        assert!(at.y > -0.7 && at.y < 0.5, "tick {tick}: {at}");
        assert!(speed < 2.0, "tick {tick}: {speed} m/s");
    }
}

#[test]
fn a_ball_falls_freely_through_a_sheet_that_it_does_not_feel() {
    let anchors_alone = FeelsCloth { contacts: false, anchors: true };
    for feels in [None, Some(anchors_alone)] {
        let (mut app, ball) = ball_on_sheet(feels);
        run(&mut app, SECOND);
        let speed = -velocity(&app, ball).y / GRAVITY;
        assert!((speed - 1.0).abs() < 0.03, "{speed} s of free fall");
    }
}

#[test]
fn a_ball_falls_when_it_ceases_to_feel_the_sheet_that_carries_it() {
    let (mut app, ball) = ball_on_sheet(Some(FeelsCloth::default()));
    run(&mut app, 2 * SECOND);
    assert!(position(&app, ball).y > -0.7);
    app.world_mut().entity_mut(ball).insert(FeelsCloth { contacts: false, anchors: true });
    run(&mut app, SECOND);
    assert!(position(&app, ball).y < -3.0, "{}", position(&app, ball));
}

/// A banner of 8 kg that hangs on an arm of a body of 100 kg, which floats: no gravity acts on it.
fn vehicle(app: &mut App, feels: bool) -> (Entity, Entity) {
    let body = (RigidBody::Dynamic, Mass(100.0), AngularInertia::new(Vec3::splat(5000.0)));
    let body = app.world_mut().spawn((body, GravityScale(0.0), Transform::default())).id();
    if feels {
        app.world_mut().entity_mut(body).insert(FeelsCloth::default());
    }
    let arm = (Transform::from_xyz(2.0, 0.0, 0.0), ChildOf(body));
    let arm = app.world_mut().spawn(arm).id();
    let heavy =
        FabricMaterial { area_density: 4.0, damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };
    let offset = Transform::from_xyz(-1.0, 0.0, 0.0);
    let held = Attachment::new(arm, ClothEdge::Top).with_offset(offset);
    let cloth = (ClothMesh::grid(17, 9, 2.0, 1.0), ClothMaterial(heavy), held);
    (body, app.world_mut().spawn(cloth).id())
}

/// Sum of mass times position of a cloth's particles, kg·m.
fn moment(app: &App, cloth: Entity) -> Vec3 {
    let areas = state(app, cloth).fabric().expect("simulated").particle_areas();
    let density = app.world().get::<ClothMaterial>(cloth).expect("a material").0.area_density;
    let places = places(app, cloth);
    places.iter().zip(areas).map(|(&at, area)| density * area * at).sum()
}

#[test]
fn a_body_and_the_banner_that_it_carries_have_the_momentum_that_gravity_gives() {
    let mut app = app();
    // Without air, gravity on the banner is the only force from outside.
    app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    let (body, cloth) = vehicle(&mut app, true);
    app.world_mut().entity_mut(body).insert(LockedAxes::ROTATION_LOCKED);
    run(&mut app, 10);
    let momentum = |app: &mut App| {
        let before = moment(app, cloth);
        app.update();
        let of_cloth = (moment(app, cloth) - before) * SECOND as f32;
        of_cloth + 100.0 * velocity(app, body)
    };
    let before = momentum(&mut app);
    run(&mut app, 2 * SECOND - 1);
    let gained = momentum(&mut app) - before;
    let given = Vec3::NEG_Y * (8.0 * GRAVITY * 2.0);
    let error = gained.distance(given) / given.length();
    assert!(error < 0.005, "{gained} of {given}: {error}");
    assert!(velocity(&app, body).y < -0.9, "{}", velocity(&app, body));
}

#[test]
fn a_banner_on_an_arm_turns_its_body() {
    let mut app = app();
    let (body, _) = vehicle(&mut app, true);
    app.world_mut().entity_mut(body).insert(LockedAxes::TRANSLATION_LOCKED);
    run(&mut app, SECOND);
    let spin = |app: &App| app.world().get::<AngularVelocity>(body).expect("a body").0;
    let before = spin(&app);
    run(&mut app, SECOND);
    // The middle of the banner is 2 m from the body: 8 kg · 9.81 m/s² · 2 m over 5,000 kg·m², and the banner's own inertia.
    let gained = spin(&app) - before;
    let expected = -8.0 * GRAVITY * 2.0 / (5000.0 + 8.0 * 4.0);
    assert!((gained.z / expected - 1.0).abs() < 0.03, "{gained}, {expected}");
    assert!(gained.x.abs() + gained.y.abs() < 0.02 * gained.z.abs(), "{gained}");
}

#[test]
fn a_body_does_not_feel_a_banner_unless_it_asks_to() {
    let mut app = app();
    let (body, cloth) = vehicle(&mut app, false);
    run(&mut app, SECOND);
    assert_eq!((velocity(&app, body), position(&app, body)), (Vec3::ZERO, Vec3::ZERO));
    assert!(app.world().get::<AnchorReactions>(cloth).is_none());
    app.world_mut().entity_mut(body).insert(FeelsCloth { contacts: true, anchors: false });
    run(&mut app, SECOND);
    assert_eq!(velocity(&app, body), Vec3::ZERO);
}

#[test]
fn a_kinematic_body_moves_as_it_is_told_to_with_a_banner_that_it_asks_to_feel() {
    let mut app = app();
    let (body, cloth) = vehicle(&mut app, true);
    let told = (RigidBody::Kinematic, LinearVelocity(Vec3::X));
    app.world_mut().entity_mut(body).insert(told);
    run(&mut app, SECOND);
    assert!(app.world().get::<AnchorReactions>(cloth).is_some());
    assert_eq!(velocity(&app, body), Vec3::X);
}
