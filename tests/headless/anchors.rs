//! Tests that a cloth is held on several entities at once.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{Fixed, Time};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, TICK, app, assert_finite, greatest_speed, run, state};

/// A banner of 2 × 0.5 m, between masts at its ends.
const BANNER: ClothMesh = ClothMesh::grid(33, 9, 2.0, 0.5);

/// Greatest distance of a held vertex from its place on its target, m: rounding.
const TOLERANCE: f32 = 1e-5;

/// A mast that moves, from where it was at first.
#[derive(Component)]
struct Mast {
    from: Vec3,
    /// Position and turn about the vertical at a time (s).
    way: fn(f32) -> (Vec3, f32),
}

fn sway(mut masts: Query<(&Mast, &mut Transform)>, time: Res<Time>) {
    for (mast, mut transform) in &mut masts {
        let (at, turn) = (mast.way)(time.elapsed_secs());
        transform.translation = mast.from + at;
        transform.rotation = Quat::from_rotation_y(turn);
    }
}

fn still(_: f32) -> (Vec3, f32) {
    (Vec3::ZERO, 0.0)
}

fn mast(app: &mut App, from: Vec3, way: fn(f32) -> (Vec3, f32)) -> Entity {
    let mast = Mast { from, way };
    app.world_mut().spawn((mast, Transform::from_translation(from))).id()
}

/// Spawns a banner between two masts; the left one is at the origin, the right one at the banner's right edge.
fn banner(app: &mut App, ways: [fn(f32) -> (Vec3, f32); 2]) -> ([Entity; 2], Entity) {
    let [left, right] = ways;
    let masts = [mast(app, Vec3::ZERO, left), mast(app, 2.0 * Vec3::X, right)];
    let right =
        Anchor::new(masts[1], ClothEdge::Right).with_offset(Transform::from_xyz(-2.0, 0.0, 0.0));
    let attachment = Attachment::new(masts[0], ClothEdge::Left).with_anchor(right);
    (masts, app.world_mut().spawn((BANNER, attachment)).id())
}

/// Positions of the ends of the lower edge in the world, m: on the left and on the right mast.
fn ends(app: &App, banner: Entity) -> [Vec3; 2] {
    let frame = app.world().get::<GlobalTransform>(banner).expect("a transform");
    let positions = state(app, banner).positions();
    let columns = if positions.len() == 33 * 9 { 33 } else { panic!("the finest level") };
    [positions.len() - columns, positions.len() - 1].map(|at| frame.transform_point(positions[at]))
}

fn finest() -> LodSet {
    LodSet { pinned: Some(0), ..LodSet::default() }
}

/// Greatest strain of a banner along its rows.
fn strain(app: &App, banner: Entity) -> f32 {
    let positions = state(app, banner).positions();
    let rows = positions.chunks(33).flat_map(|row| row.windows(2));
    rows.map(|link| link[0].distance(link[1]) * 16.0 - 1.0).fold(0.0, f32::max)
}

#[test]
fn a_banner_stays_on_both_masts() {
    fn nods(time: f32) -> (Vec3, f32) {
        (
            Vec3::new(-0.3 * (3.0 * time).sin().abs(), 0.2 * (5.0 * time).sin(), 0.0),
            0.3 * time.sin(),
        )
    }
    for in_update in [true, false] {
        let mut app = app();
        if in_update {
            app.add_systems(Update, sway);
        } else {
            app.add_systems(FixedUpdate, sway);
        }
        let (masts, banner) = banner(&mut app, [still, nods]);
        app.world_mut().entity_mut(banner).insert(finest());
        // The masts move while the banner is put on them.
        run(&mut app, (2.0 / TICK) as usize);
        for _ in 0..120 {
            run(&mut app, 1);
            let [left, right] = ends(&app, banner);
            assert!(left.distance(Vec3::new(0.0, -0.5, 0.0)) < TOLERANCE, "{left}");
            let mast = app.world().get::<Transform>(masts[1]).expect("a mast");
            let place = mast.transform_point(Vec3::new(0.0, -0.5, 0.0));
            // Masts that are moved in frames are shown a frame later.
            let late = if in_update { 0.06 } else { TOLERANCE };
            assert!(right.distance(place) < late, "{right} for {place}, in update: {in_update}");
            assert!(strain(&app, banner) < 0.1, "{}", strain(&app, banner));
        }
    }
}

#[test]
fn two_masts_that_move_as_one_are_like_one() {
    fn sways(time: f32) -> (Vec3, f32) {
        (Vec3::new(0.3 * (4.0 * time).sin(), 0.0, 0.2 * (3.0 * time).sin()), 0.0)
    }
    let mut app = app();
    app.add_systems(FixedUpdate, sway);
    let (masts, by_two) = banner(&mut app, [sways, sways]);
    let both: Vec<u32> = (0..9).flat_map(|row| [row * 33, row * 33 + 32]).collect();
    let on_one = Attachment::new(masts[0], AttachedVertices::List(both));
    let by_one = app.world_mut().spawn((BANNER, on_one)).id();
    for cloth in [by_one, by_two] {
        app.world_mut().entity_mut(cloth).insert(finest());
    }
    run(&mut app, 60);
    let pairs = state(&app, by_one).positions().iter().zip(state(&app, by_two).positions());
    let apart = pairs.map(|(one, two)| one.distance(*two)).fold(0.0, f32::max);
    assert!(apart < 1e-3, "{apart} m");
}

/// Both masts are fast from their first frame on: that is a teleport of both, and then the velocity of both.
#[test]
fn a_banner_that_is_new_between_fast_vehicles_is_not_torn_along() {
    fn drives(time: f32) -> (Vec3, f32) {
        (Vec3::new(0.0, 0.0, -20.0 * time), 0.0)
    }
    for in_update in [true, false] {
        let mut app = app();
        // The wind of travel is that of another test.
        app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
        if in_update {
            app.add_systems(Update, sway);
        } else {
            app.add_systems(FixedUpdate, sway);
        }
        let (_, banner) = banner(&mut app, [drives, drives]);
        app.world_mut().entity_mut(banner).insert(finest());
        let (mut worst, mut behind) = (0.0_f32, 0.0_f32);
        for _ in 0..120 {
            run(&mut app, 1);
            let positions = state(&app, banner).positions();
            if !positions.is_empty() {
                worst = worst.max(strain(&app, banner));
                behind = positions.iter().map(|at| at.z.abs()).fold(behind, f32::max);
            }
        }
        assert!(worst < 0.02, "stretched by {worst}, in update: {in_update}");
        assert!(behind < 0.05, "{behind} m behind, in update: {in_update}");
    }
}

#[test]
fn an_anchor_far_from_its_place_is_reached_gently() {
    let mut app = app();
    app.add_systems(FixedUpdate, sway);
    fn apart(_: f32) -> (Vec3, f32) {
        (Vec3::new(-1.0, 0.5, 0.5), 0.0)
    }
    let (_, banner) = banner(&mut app, [still, apart]);
    app.world_mut().entity_mut(banner).insert(finest());
    let mut worst = 0.0_f32;
    for _ in 0..120 {
        run(&mut app, 1);
        if !state(&app, banner).positions().is_empty() {
            worst = worst.max(strain(&app, banner));
        }
    }
    assert!(worst < 0.1, "strain {worst}");
    let [_, right] = ends(&app, banner);
    let place = Vec3::new(1.0, 0.0, 0.5);
    assert!(right.distance(place) < TOLERANCE, "{right}");
}

#[test]
fn a_requested_teleport_of_a_mast_does_not_tear_its_edge_along() {
    fn jumps(time: f32) -> (Vec3, f32) {
        (if time > 2.0 { 0.2 * Vec3::new(-1.0, 1.0, 0.0) } else { Vec3::ZERO }, 0.0)
    }
    let fastest = |requested: bool| {
        let mut app = app();
        app.add_systems(FixedUpdate, sway);
        let (_, banner) = banner(&mut app, [still, jumps]);
        app.world_mut().entity_mut(banner).insert(finest());
        let mut fastest = 0.0_f32;
        for _ in 0..(3.0 / TICK) as usize {
            let before = app.world().resource::<Time<Fixed>>().elapsed_secs();
            if requested && before <= 2.0 && before + TICK > 2.0 {
                app.world_mut().trigger(TeleportCloth { entity: banner, mode: TeleportMode::Keep });
            }
            run(&mut app, 1);
            let time = app.world().resource::<Time<Fixed>>().elapsed_secs();
            if time > 1.9 {
                fastest = fastest.max(greatest_speed(&app, banner));
            }
        }
        fastest
    };
    let (requested, seen) = (fastest(true), fastest(false));
    assert!(requested < 1.5 && seen > 5.0, "{requested} and {seen} m/s");
}

#[test]
fn a_moving_anchor_wakes_its_cloth() {
    fn later(time: f32) -> (Vec3, f32) {
        (if time > 60.0 { -0.2 * (time - 60.0).min(1.0) * Vec3::X } else { Vec3::ZERO }, 0.0)
    }
    let mut app = app();
    app.add_systems(FixedUpdate, sway);
    let (_, banner) = banner(&mut app, [still, later]);
    app.world_mut().entity_mut(banner).insert(finest());
    run(&mut app, (59.5 / TICK) as usize);
    assert_eq!(state(&app, banner).activity(), ClothActivity::AtRest);
    run(&mut app, (2.0 / TICK) as usize);
    let [_, right] = ends(&app, banner);
    assert!(right.distance(Vec3::new(1.8, -0.5, 0.0)) < TOLERANCE, "{right}");
}

#[test]
fn anchors_hold_through_changes_of_level() {
    let mut app = app();
    app.add_systems(FixedUpdate, sway);
    fn near(_: f32) -> (Vec3, f32) {
        (-0.4 * Vec3::X, 0.0)
    }
    let (_, banner) = banner(&mut app, [still, near]);
    run(&mut app, 10);
    let mut worst = 0.0_f32;
    for change in 0..40 {
        let lods = LodSet::new([10.0, 20.0]).pinned_to(change % 3);
        app.world_mut().entity_mut(banner).insert(lods);
        for _ in 0..8 {
            run(&mut app, 1);
            let cloth = state(&app, banner);
            let held = cloth.positions().last().expect("vertices");
            if change > 15 {
                worst = worst.max(held.distance(Vec3::new(1.6, -0.5, 0.0)));
            }
        }
        assert_finite(&app, banner);
    }
    assert!(worst < 2e-3, "{worst} m");
}

#[test]
fn an_anchor_without_a_target_is_reported() {
    let mut app = app();
    let mast = app.world_mut().spawn(Transform::default()).id();
    let nobody = app.world_mut().spawn_empty().id();
    let attachment =
        Attachment::new(mast, ClothEdge::Left).with_anchor(Anchor::new(nobody, ClothEdge::Right));
    let banner = app.world_mut().spawn((BANNER, attachment)).id();
    run(&mut app, 3);
    assert!(state(&app, banner).fabric().is_none());
    let failed = &app.world().resource::<Seen<ClothFailed>>().0;
    let [ClothFailed { error: ClothError::MissingTarget { entity, target }, .. }] = failed[..]
    else {
        panic!("{failed:?}")
    };
    assert_eq!((entity, target), (banner, nobody));
}

#[test]
fn a_lost_anchor_freezes_the_cloth_or_releases_its_vertices() {
    for on_lost in [TargetLost::Freeze, TargetLost::Release] {
        let mut app = app();
        let (masts, banner) = banner(&mut app, [still, still]);
        app.world_mut().get_mut::<Attachment>(banner).expect("attached").on_lost = on_lost;
        app.world_mut().entity_mut(banner).insert(finest());
        run(&mut app, 30);
        app.world_mut().despawn(masts[1]);
        run(&mut app, 60);
        let lost = &app.world().resource::<Seen<ClothTargetLost>>().0;
        let expected = ClothTargetLost { entity: banner, target: masts[1], outcome: on_lost };
        assert_eq!(*lost, [expected]);
        let [left, right] = ends(&app, banner);
        assert!(left.distance(Vec3::new(0.0, -0.5, 0.0)) < TOLERANCE, "{left}");
        match on_lost {
            TargetLost::Freeze => {
                assert!(app.world().get::<ClothPaused>(banner).is_some());
                assert!(right.distance(Vec3::new(2.0, -0.5, 0.0)) < TOLERANCE, "{right}");
            }
            TargetLost::Release => assert!(right.y < -1.0, "it falls: {right}"),
        }
    }
}
