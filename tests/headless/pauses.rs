//! Tests that what moves while no time passes is a teleport, whatever its length.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::prelude::*;
use bunting_tests::{app, greatest, greatest_speed, run, state, stretches};

/// Ticks in which a damped sheet comes to rest.
const SETTLING: usize = 64 * 5;

/// Speed of a sheet that has come almost to rest, m/s.
const SLOW: f32 = 0.1;

/// Moves of a target in a pause, m.
const MOVES: [f32; 4] = [0.05, 0.3, 0.6, 5.0];

/// How time is stopped.
const STOPS: [fn(&mut Time<Virtual>); 2] =
    [|time| time.pause(), |time| time.set_relative_speed(0.0)];

/// A damped sheet, on a pole by its upper edge, that is held as well by what `held` adds.
fn sheet(app: &mut App, held: impl Fn(&mut World, Attachment) -> Attachment) -> [Entity; 2] {
    let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };
    let attachment = held(app.world_mut(), Attachment::new(pole, ClothEdge::Top));
    let finest = LodSet { pinned: Some(0), ..LodSet::default() };
    let mesh = ClothMesh::grid(9, 9, 1.0, 1.0);
    [pole, app.world_mut().spawn((mesh, ClothMaterial(material), attachment, finest)).id()]
}

/// Stops the time, lets `moves` act in the pause, and returns the greatest speed of a sheet (m/s) in the second after,
/// and the greatest length of a link as a part of that at rest.
fn whipped(
    app: &mut App,
    sheet: Entity,
    stop: fn(&mut Time<Virtual>),
    moves: impl Fn(&mut World),
) -> [f32; 2] {
    run(app, SETTLING);
    let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
    stop(&mut time);
    run(app, 10);
    moves(app.world_mut());
    run(app, 3);
    let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
    time.unpause();
    time.set_relative_speed(1.0);
    let ticks = (0..64).map(|_| {
        run(app, 1);
        [greatest_speed(app, sheet), greatest(stretches(app, sheet))]
    });
    ticks.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]).expect("ticks")
}

#[test]
fn a_target_that_moves_in_a_pause_carries_its_cloth_along() {
    for stop in STOPS {
        for way in MOVES {
            let mut app = app();
            let [pole, sheet] = sheet(&mut app, |_, held| held);
            let [speed, _] = whipped(&mut app, sheet, stop, |world| {
                world.entity_mut(pole).insert(Transform::from_xyz(way, 3.0, 0.0));
            });
            assert!(speed < SLOW, "{speed} m/s by {way} m");
            let at = app.world().get::<GlobalTransform>(sheet).expect("a transform");
            assert_eq!(at.translation().x, way);
        }
    }
}

#[test]
fn a_target_that_moves_between_the_last_frame_of_a_pause_and_the_next_is_teleported() {
    let mut app = app();
    let [pole, sheet] = sheet(&mut app, |_, held| held);
    run(&mut app, SETTLING);
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    run(&mut app, 10);
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    app.world_mut().entity_mut(pole).insert(Transform::from_xyz(0.3, 3.0, 0.0));
    for _ in 0..64 {
        run(&mut app, 1);
        let speed = greatest_speed(&app, sheet);
        assert!(speed < SLOW, "{speed} m/s");
    }
}

#[test]
fn an_anchor_that_moves_in_a_pause_is_reached_gently() {
    for way in [0.05, 0.3] {
        let mut app = app();
        let mast = app.world_mut().spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
        let [_, sheet] =
            sheet(&mut app, |_, held| held.with_anchor(Anchor::new(mast, ClothEdge::Bottom)));
        let [speed, stretch] = whipped(&mut app, sheet, STOPS[0], |world| {
            world.entity_mut(mast).insert(Transform::from_xyz(0.0, 3.0 + way, 0.0));
        });
        assert!(speed < 2.0 && stretch < 1.05, "{speed} m/s, {stretch} by {way} m");
    }
}

#[test]
fn a_collider_that_moves_in_a_pause_through_a_cloth_does_not_push_it() {
    for way in [0.5, 3.0] {
        let mut app = app();
        let [_, sheet] = sheet(&mut app, |_, held| held);
        let ball = (ClothCollider::ball(0.1), Transform::from_xyz(0.5, 2.5, -0.2));
        let ball = app.world_mut().spawn(ball).id();
        let [speed, _] = whipped(&mut app, sheet, STOPS[0], |world| {
            world.entity_mut(ball).insert(Transform::from_xyz(0.5, 2.5, -0.2 + way));
        });
        assert!(speed < SLOW, "{speed} m/s by {way} m");
    }
}

#[test]
fn joints_that_move_in_a_pause_carry_their_cloth_along() {
    // In the hips' frame, a tenth of a metre and more; and a joint that grows.
    let moves = [0.1, 0.3, 2.0].map(|way| Transform::from_xyz(way, 0.0, 0.0));
    for moved in moves.into_iter().chain([Transform::from_scale(Vec3::splat(1.5))]) {
        let mut app = app();
        let [pole, sheet] = sheet(&mut app, |_, held| held);
        let joint = app.world_mut().spawn((Transform::default(), ChildOf(pole))).id();
        let rigid = ([0; 4], [1.0, 0.0, 0.0, 0.0]);
        let skin = ClothSkin::new([(joint, Mat4::IDENTITY)])
            .with_vertices(core::iter::repeat_n(rigid, 9 * 9));
        app.world_mut().entity_mut(sheet).insert(skin);
        let [speed, _] = whipped(&mut app, sheet, STOPS[0], |world| {
            world.entity_mut(joint).insert(moved);
        });
        // A larger cloth springs back to its size at rest.
        let limit = if moved.scale == Vec3::ONE { SLOW } else { 50.0 };
        assert!(speed < limit, "{speed} m/s by {moved:?}");
        let corner = state(&app, sheet).positions()[8];
        let place = moved.transform_point(Vec3::X);
        assert!(corner.distance(place) < 1e-5, "{corner} for {place}");
    }
}
