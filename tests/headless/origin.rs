//! Tests of a floating origin: the world is moved as a whole, and cloth does not notice.

use bevy_app::{App, FixedUpdate};
use bevy_bunting::TickWind;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{TICK, app, assert_finite, bits, greatest, logged, run, state};

/// Greatest change of any particle's velocity that a shift may make, m/s.
const JOLT: f32 = 1e-3;

/// Speed of what moves, m/s: in a tick it moves by a number without rounding.
const SPEED: f32 = 5.0;

#[derive(Component)]
struct Moving;

/// Moves all transforms without a parent, and all that cloth knows.
fn shift(app: &mut App, by: Vec3) {
    let world = app.world_mut();
    let mut roots = world.query_filtered::<&mut Transform, Without<ChildOf>>();
    roots.iter_mut(world).for_each(|mut it| it.translation += by);
    world.trigger(ShiftOrigin { by });
}

/// A flag on a mast that drives through gusts, a draught and a fan, behind a lorry and after a blast. It touches nothing: contacts
/// make much of rounding.
fn windy(has_gusts: bool) -> (App, Entity) {
    let mut app = app();
    let world = app.world_mut();
    let gusts = |strength: f32| if has_gusts { strength } else { 0.0 };
    world.spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)).with_gusts(gusts(2.0), 0.7, 3));
    let gusts = WindField::steady(Vec3::Z).with_gusts(gusts(1.0), 0.9, 5);
    world.spawn((gusts, WindRegion::ball(9.0, 2.0), Transform::from_xyz(5.0, 2.0, 0.0)));
    world.spawn((WindFan::new(6.0, 0.5), Transform::from_xyz(6.0, 2.0, 4.0)));
    world.spawn((WindBlast::new(20.0, 2.0), Transform::from_xyz(30.0, 0.0, 30.0)));
    world.spawn((WindWake::new(6.0), Moving, Transform::from_xyz(4.0, 1.0, 0.0)));
    world.spawn((ClothCollider::ball(0.5), Transform::from_xyz(6.0, -1.0, -0.3)));
    let mast = world.spawn((Moving, Transform::from_xyz(0.0, 2.5, 0.0))).id();
    let held = Attachment::new(mast, ClothEdge::Left);
    let flag = world.spawn((ClothMesh::grid(17, 9, 1.5, 1.0), held)).id();
    let drive = |mut moving: Query<&mut Transform, With<Moving>>| {
        moving.iter_mut().for_each(|mut it| it.translation.x += SPEED * TICK);
    };
    app.add_systems(FixedUpdate, drive);
    run(&mut app, 60);
    (app, flag)
}

/// Greatest difference of the velocities of particles of two cloths that are alike, m/s.
fn jolt(apps: [&App; 2], cloth: Entity) -> f32 {
    let [one, other] = apps.map(|app| state(app, cloth).velocities().collect::<Vec<_>>());
    greatest(one.iter().zip(&other).map(|(a, b)| a.distance(*b)))
}

#[test]
fn a_shift_of_any_length_jolts_no_cloth() {
    for by in [
        Vec3::new(16.0, 0.0, -32.0),
        Vec3::new(-512.0, 64.0, 1024.25),
        Vec3::new(8192.0, 0.0, -4096.0),
    ] {
        let [(mut still, flag), (mut moved, _)] = [windy(true), windy(true)];
        shift(&mut moved, by);
        // Later the flag makes more and more of the rounding of gusts, as of any other push.
        for tick in 0..5 {
            run(&mut still, 1);
            run(&mut moved, 1);
            let jolt = jolt([&still, &moved], flag);
            assert!(jolt < JOLT, "{jolt} m/s, {tick} ticks after a shift by {by}");
        }
        run(&mut still, 25);
        run(&mut moved, 25);
        assert!(jolt([&still, &moved], flag) < 0.3, "gusts go on");
        assert_finite(&moved, flag);
    }
}

#[test]
fn a_shift_in_each_frame_changes_no_bit_without_gusts() {
    let [(mut still, flag), (mut moved, _)] = [windy(false), windy(false)];
    for frame in 0..90 {
        // Whole parts of a metre are added without rounding.
        let length = [300.0, -200.5, 17.25, -116.75][frame % 4];
        shift(&mut moved, Vec3::new(length, -0.5 * length, 2.0 * length));
        run(&mut still, 1);
        run(&mut moved, 1);
        assert_eq!(bits(&still, flag), bits(&moved, flag), "in frame {frame}");
    }
    assert!(greatest(state(&moved, flag).velocities().map(|it| it.length())) > SPEED);
}

#[test]
fn winds_are_where_they_were() {
    let (mut app, _) = windy(true);
    let at = |app: &App, place: Vec3| app.world().resource::<TickWind>().at(place);
    let places = [Vec3::new(3.0, 2.0, 1.0), Vec3::new(6.0, 2.0, 3.0), Vec3::new(-2.0, 1.0, 0.2)];
    let before = places.map(|place| at(&app, place));
    let by = Vec3::new(256.0, -64.0, 512.0);
    shift(&mut app, by);
    for (place, before) in places.into_iter().zip(before) {
        let now = at(&app, place + by);
        assert!(now.distance(before) < 1e-2, "{before} became {now} at once");
    }
    let (mut still, _) = windy(true);
    run(&mut still, 5);
    run(&mut app, 5);
    for place in places {
        let [here, there] = [at(&still, place), at(&app, place + by)];
        assert!(here.distance(there) < 1e-2, "{here} is {there}");
    }
}

#[test]
fn what_sleeps_goes_on_sleeping() {
    let mut app = app();
    let world = app.world_mut();
    world.spawn((WindField::steady(Vec3::X), WindRegion::ball(3.0, 1.0)));
    world.spawn((ClothCollider::cuboid(Vec3::splat(0.4)), Transform::from_xyz(0.1, -0.7, 0.3)));
    // The frame of the second one is that of a grandchild, which rounding moves.
    let pose = Transform::from_xyz(0.3, 0.17, 0.9).with_rotation(Quat::from_rotation_y(0.3));
    let parent = world.spawn(pose).id();
    let child = world.spawn((Transform::from_xyz(1.7, 0.0, 0.1), ChildOf(parent))).id();
    let sheet = || ClothMesh::grid(9, 9, 1.0, 1.0);
    let hung = |on: Entity| Attachment::new(on, ClothEdge::Top);
    let post = world.spawn(Transform::from_xyz(-4.0, 0.0, 0.0)).id();
    let cloths = [post, child].map(|on| world.spawn((sheet(), hung(on))).id());
    run(&mut app, 900);
    let shapes = cloths.map(|cloth| bits(&app, cloth));
    let activities = |app: &App| cloths.map(|cloth| state(app, cloth).activity());
    assert_eq!(activities(&app), [ClothActivity::AtRest; 2]);
    for by in
        [Vec3::splat(1234.567), Vec3::new(-1.0e5, 3.0, 0.1), Vec3::new(98_765.4, -1234.5, 0.0)]
    {
        shift(&mut app, by);
        run(&mut app, 1);
        assert_eq!(activities(&app), [ClothActivity::AtRest; 2], "after a shift by {by}");
        run(&mut app, 5);
    }
    (0..60).for_each(|frame| {
        let by = if frame % 2 == 0 { 100.3 } else { -100.7 };
        shift(&mut app, Vec3::splat(by));
        run(&mut app, 1);
    });
    assert_eq!(activities(&app), [ClothActivity::AtRest; 2]);
    assert_eq!(cloths.map(|cloth| bits(&app, cloth)), shapes);
}

#[test]
fn cloth_lies_on_what_was_moved_with_it() {
    let lying = || {
        let mut app = app();
        let world = app.world_mut();
        world.spawn((ClothCollider::ball(0.5), Transform::from_xyz(0.5, -0.6, 0.25)));
        let at = Transform::from_xyz(0.5, 0.1, 0.25);
        let cloth = world.spawn((ClothMesh::sheet(17, 17, 1.0, 1.0), at)).id();
        run(&mut app, 150);
        (app, cloth)
    };
    let [(mut still, cloth), (mut moved, _)] = [lying(), lying()];
    for frame in 0..40 {
        shift(&mut moved, Vec3::new(64.0, 0.0, -32.0) * if frame % 2 == 0 { 1.0 } else { -1.0 });
        run(&mut still, 1);
        run(&mut moved, 1);
        let jolt = jolt([&still, &moved], cloth);
        assert!(jolt < JOLT, "{jolt} m/s in frame {frame}");
    }
    let lowest = state(&moved, cloth).positions().iter().map(|at| at.y);
    assert!(greatest(lowest.map(|y| -y)) < 1.2, "the ball holds it");
}

#[test]
fn anchors_and_impulses_move_along() {
    let hung = || {
        let mut app = app();
        let world = app.world_mut();
        let masts = [0.3, 1.77].map(|x| world.spawn(Transform::from_xyz(x, 3.1, 0.7)).id());
        let second = Anchor::at(masts[1], ClothEdge::Right);
        let held = Attachment::at(masts[0], ClothEdge::Left).with_anchor(second);
        let banner = world.spawn((ClothMesh::grid(17, 9, 1.5, 1.0), held)).id();
        run(&mut app, 200);
        (app, banner)
    };
    let [(mut still, banner), (mut moved, _)] = [hung(), hung()];
    for by in [700.0, -699.0, 33.0] {
        shift(&mut moved, Vec3::splat(by));
        run(&mut still, 1);
        run(&mut moved, 1);
        let jolt = jolt([&still, &moved], banner);
        assert!(jolt < JOLT, "{jolt} m/s after a shift by {by}");
    }
    // An impulse that is on its way hits what it was for.
    let middle = Vec3::new(1.05, 2.6, 0.7);
    let push = |at: Vec3| ClothImpulse::velocity(at, 0.4, 3.0 * Vec3::Z);
    still.world_mut().trigger(push(middle));
    moved.world_mut().trigger(push(middle + Vec3::splat(34.0)));
    shift(&mut moved, Vec3::splat(-200.0));
    run(&mut still, 1);
    run(&mut moved, 1);
    assert!(greatest(state(&moved, banner).velocities().map(|it| it.z)) > 0.5);
    assert!(jolt([&still, &moved], banner) < 1e-2);
}

#[test]
fn a_shift_that_is_not_finite_is_left_out() {
    logged();
    let (mut app, flag) = windy(true);
    let (mut still, _) = windy(true);
    app.world_mut().trigger(ShiftOrigin { by: Vec3::new(f32::NAN, 0.0, 0.0) });
    run(&mut app, 5);
    run(&mut still, 5);
    assert_eq!(bits(&app, flag), bits(&still, flag));
    assert!(logged().iter().any(|it| it.contains("ShiftOrigin by [NaN, 0, 0]")));
}
