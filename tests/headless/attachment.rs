//! Tests that attached vertices stay on their target, however the target is moved.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{
    FLAG, Seen, TICK, app, app_at, assert_finite, bits, greatest, greatest_speed, run, state,
};

/// Greatest distance of an attached vertex from its place on the target, m: rounding.
const TOLERANCE: f32 = 1e-5;

/// Speed of the target, m/s.
const SPEED: f32 = 20.0;

/// Pose of the flag in the frame of the vehicle.
const OFFSET: Transform = Transform::from_xyz(-0.3, 1.4, 0.2);

#[derive(Component)]
struct Vehicle;

/// Moves vehicles along a circle of 10 m and spins them once a second about a tilted axis.
fn drive(mut vehicles: Query<&mut Transform, With<Vehicle>>, time: Res<Time>) {
    let radius = 10.0;
    let seconds = time.elapsed_secs();
    let angle = seconds * SPEED / radius;
    for mut transform in &mut vehicles {
        transform.translation = radius * Vec3::new(angle.cos(), 0.0, angle.sin());
        let axis = Vec3::new(0.2, 1.0, -0.1).normalize();
        transform.rotation = Quat::from_axis_angle(axis, core::f32::consts::TAU * seconds);
    }
}

fn attached(app: &mut App, child: bool) -> (Entity, Entity) {
    let vehicle = app.world_mut().spawn((Vehicle, Transform::default())).id();
    let attachment = Attachment::new(vehicle, ClothEdge::Left).with_offset(OFFSET);
    let cloth = app.world_mut().spawn((FLAG, attachment)).id();
    if child {
        app.world_mut().entity_mut(cloth).insert(ChildOf(vehicle));
    }
    (vehicle, cloth)
}

/// The greatest distance of an attached vertex from its place, m.
fn error(app: &App, vehicle: Entity, cloth: Entity) -> f32 {
    let global = |entity: Entity| app.world().get::<GlobalTransform>(entity).expect("a transform");
    let state = state(app, cloth);
    let fabric = state.fabric().expect("a fabric");
    let pinned = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
    let errors = pinned.map(|particle| {
        let drawn = global(cloth).transform_point(state.positions()[particle]);
        let place = OFFSET.transform_point(fabric.rest_positions()[particle]);
        drawn.distance(global(vehicle).transform_point(place))
    });
    greatest(errors)
}

#[test]
fn attached_vertices_stay_on_a_fast_spinning_target() {
    for rate in [30.0, 60.0, 144.0] {
        for in_update in [true, false] {
            for child in [true, false] {
                let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
                if in_update {
                    app.add_systems(Update, drive);
                } else {
                    app.add_systems(FixedUpdate, drive);
                }
                let (vehicle, cloth) = attached(&mut app, child);
                run(&mut app, 10);
                for _ in 0..(2.0 * rate) as usize {
                    app.update();
                    let error = error(&app, vehicle, cloth);
                    assert!(error < TOLERANCE, "{error} m, {rate} Hz, {in_update}, {child}");
                }
                assert_finite(&app, cloth);
            }
        }
    }
}

#[test]
fn transforms_are_right_when_published() {
    #[derive(Resource)]
    struct Both(Entity, Entity);
    let mut app = app();
    app.add_systems(FixedUpdate, drive);
    let (vehicle, cloth) = attached(&mut app, false);
    app.insert_resource(Both(vehicle, cloth)).add_systems(
        FixedLast,
        |both: Res<Both>, transforms: Query<&Transform>, globals: Query<&GlobalTransform>| {
            let vehicle = transforms.get(both.0).expect("a vehicle");
            let cloth = globals.get(both.1).expect("a cloth").translation();
            let error = cloth.distance(vehicle.transform_point(OFFSET.translation));
            assert!(error < TOLERANCE, "{error} m");
        },
    );
    run(&mut app, 60);
}

#[test]
fn a_steady_ride_is_smooth_in_either_schedule() {
    fn straight(mut vehicles: Query<&mut Transform, With<Vehicle>>, time: Res<Time>) {
        for mut transform in &mut vehicles {
            transform.translation.x = -time.elapsed_secs();
        }
    }
    let mut speeds = Vec::new();
    for in_update in [true, false] {
        let mut app = app_at(Duration::from_secs_f64(1.0 / 47.0));
        if in_update {
            app.add_systems(Update, straight);
        } else {
            app.add_systems(FixedUpdate, straight);
        }
        let (_, cloth) = attached(&mut app, false);
        // The cloth hangs from its top, slow and damped, so that it neither folds nor flutters: only jerks of
        // its frame can move it.
        let mut held = app.world_mut().get_mut::<Attachment>(cloth).expect("attached");
        held.vertices = ClothEdge::Top.into();
        let damped = FabricMaterial { damping: 5.0, ..FabricMaterial::FLAG_POLYESTER };
        app.world_mut().entity_mut(cloth).insert(ClothMaterial(damped));
        run(&mut app, 400);
        let later = (0..40).map(|_| {
            app.update();
            greatest_speed(&app, cloth)
        });
        speeds.push(greatest(later));
    }
    assert!(speeds.iter().all(|&speed| speed < 0.02), "{speeds:?} m/s");
}

#[test]
fn a_teleport_carries_the_cloth_along_without_a_velocity() {
    let mut app = app();
    let (vehicle, cloth) = attached(&mut app, false);
    let (_, other) = attached(&mut app, false);
    run(&mut app, 60);
    let jump = Transform::from_xyz(100.0, 0.0, 0.0);
    app.world_mut().entity_mut(vehicle).insert(jump);
    for _ in 0..30 {
        app.update();
        assert_eq!(bits(&app, cloth), bits(&app, other), "the jump changes no bit");
    }
    assert!(error(&app, vehicle, cloth) < TOLERANCE);
}

/// A flag on a vehicle that is fast from its first frame: the first change of place is a teleport, and after it the flag
/// has the vehicle's velocity and flies in the wind of travel.
#[test]
fn a_flag_that_is_new_on_a_fast_vehicle_flies_in_the_wind_of_travel() {
    fn ride<const SPEED: u32>(mut vehicles: Query<&mut Transform, With<Vehicle>>) {
        for mut transform in &mut vehicles {
            transform.translation.x -= SPEED as f32 * TICK;
        }
    }
    for (speed, in_update) in [(20, true), (20, false), (40, true), (40, false)] {
        let mut app = app();
        match (speed, in_update) {
            (20, true) => app.add_systems(Update, ride::<20>),
            (20, false) => app.add_systems(FixedUpdate, ride::<20>),
            (_, true) => app.add_systems(Update, ride::<40>),
            (_, false) => app.add_systems(FixedUpdate, ride::<40>),
        };
        let (_, flag) = attached(&mut app, false);
        let mut longest = 0.0_f32;
        for _ in 0..120 {
            run(&mut app, 1);
            if let [corner, .., tip] = state(&app, flag).positions().get(..17).unwrap_or(&[]) {
                longest = longest.max(tip.distance(*corner));
            }
        }
        let positions = state(&app, flag).positions();
        let way = positions[16] - positions[0];
        assert!(way.x > 0.5, "it trails: {way}, {speed} m/s, in update: {in_update}");
        assert!(longest < 1.52, "{longest} m of 1.5, {speed} m/s, in update: {in_update}");
    }
}

#[test]
fn a_small_jump_is_a_teleport_only_on_request() {
    // The jump is 19 m/s in one tick.
    let moved = Transform::from_xyz(0.3, 0.0, 0.0);
    let speed = |request: Option<TeleportMode>| {
        let mut app = app();
        let (vehicle, cloth) = attached(&mut app, false);
        run(&mut app, 60);
        let before = greatest_speed(&app, cloth);
        app.world_mut().entity_mut(vehicle).insert(moved);
        if let Some(mode) = request {
            app.world_mut().trigger(TeleportCloth { entity: cloth, mode });
        }
        let later = (0..3).map(|_| {
            app.update();
            greatest_speed(&app, cloth)
        });
        (before, greatest(later))
    };
    let (before, after) = speed(Some(TeleportMode::Keep));
    assert!(after < before + 1.0, "{after} m/s");
    let (_, after) = speed(Some(TeleportMode::Reset));
    assert!(after < 1.0, "{after} m/s");
    let (_, after) = speed(None);
    assert!(after > 5.0, "{after} m/s");
}

#[test]
fn a_lost_target_freezes_or_releases() {
    for on_lost in [TargetLost::Freeze, TargetLost::Release] {
        let mut app = app();
        let (vehicle, cloth) = attached(&mut app, false);
        app.world_mut().get_mut::<Attachment>(cloth).expect("attached").on_lost = on_lost;
        app.world_mut().get_mut::<Transform>(vehicle).expect("placed").translation.z = 7.0;
        run(&mut app, 30);
        let before = bits(&app, cloth);
        app.world_mut().despawn(vehicle);
        run(&mut app, 60);
        let lost = &app.world().resource::<Seen<ClothTargetLost>>().0;
        assert_eq!(*lost, [ClothTargetLost { entity: cloth, target: vehicle, outcome: on_lost }]);
        assert_finite(&app, cloth);
        let global = app.world().get::<GlobalTransform>(cloth).expect("a transform").translation();
        assert!((global - Vec3::new(-0.3, 1.4, 7.2)).length() < TOLERANCE);
        match on_lost {
            TargetLost::Freeze => {
                assert_eq!(bits(&app, cloth), before);
                app.world_mut().entity_mut(cloth).remove::<ClothPaused>();
                run(&mut app, 10);
                assert_ne!(bits(&app, cloth), before);
                assert_eq!(
                    state(&app, cloth).positions()[0],
                    Vec3::ZERO,
                    "it is held where it was"
                );
            }
            TargetLost::Release => {
                assert!(state(&app, cloth).positions()[0].y < -1.0, "it falls");
            }
        }
        assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    }
}

#[test]
fn a_cloth_left_behind_is_pulled_along() {
    let mut app = app();
    app.add_systems(FixedUpdate, |mut vehicles: Query<&mut Transform, With<Vehicle>>| {
        for mut transform in &mut vehicles {
            transform.translation.z += 3.0 * TICK;
        }
    });
    let (_, cloth) = attached(&mut app, false);
    run(&mut app, 200);
    let tip = state(&app, cloth).positions()[16];
    assert!(tip.z < -0.3, "{tip}");
}

/// Moves an entity along z for 30 ticks. Returns the distance that the tip of the cloth has moved in its
/// frame, m.
fn swing(app: &mut App, mover: Entity, vehicle: Entity, cloth: Entity) -> f32 {
    let tip = |app: &App| state(app, cloth).positions()[16];
    let before = tip(app);
    for _ in 0..30 {
        app.world_mut().get_mut::<Transform>(mover).expect("it stays").translation.z += 0.1;
        app.update();
        let error = error(app, vehicle, cloth);
        assert!(error < TOLERANCE, "{error} m");
    }
    tip(app).distance(before)
}

/// Number of ticks after which an unmoved target is no longer observed, until it moves.
const LONG: usize = 60;

/// Least swing that proves that a cloth felt the motion of its frame, m.
const FELT: f32 = 0.2;

#[test]
fn a_target_that_has_rested_is_followed_when_it_moves() {
    let mut app = app();
    let (vehicle, cloth) = attached(&mut app, false);
    let lorry = app.world_mut().spawn(Transform::from_xyz(1.0, 0.0, 0.0)).id();
    app.world_mut().entity_mut(vehicle).insert(ChildOf(lorry));
    run(&mut app, LONG);
    let by_parent = swing(&mut app, lorry, vehicle, cloth);
    assert!(by_parent > FELT, "{by_parent} m");

    let other = app.world_mut().spawn(Transform::from_xyz(0.0, 0.5, 3.0)).id();
    run(&mut app, LONG);
    app.world_mut().get_mut::<Attachment>(cloth).expect("attached").target = other;
    run(&mut app, LONG);
    let by_other = swing(&mut app, other, other, cloth);
    assert!(by_other > FELT, "{by_other} m");

    run(&mut app, LONG);
    app.world_mut().entity_mut(other).insert(ChildOf(lorry));
    app.update();
    assert!(error(&app, other, cloth) < TOLERANCE);
    run(&mut app, LONG);
    let by_new_parent = swing(&mut app, lorry, other, cloth);
    assert!(by_new_parent > FELT, "{by_new_parent} m");
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

#[test]
fn a_detached_cloth_does_not_follow() {
    let mut app = app();
    let (vehicle, cloth) = attached(&mut app, false);
    run(&mut app, LONG);
    app.world_mut().entity_mut(cloth).remove::<Attachment>();
    run(&mut app, 2);
    let stood = *app.world().get::<Transform>(cloth).expect("a transform");
    app.world_mut().get_mut::<Transform>(vehicle).expect("it stays").translation.z += 1.0;
    run(&mut app, 2);
    assert_eq!(app.world().get::<Transform>(cloth), Some(&stood));
}

/// Length of a frame such that several frames pass between two ticks.
const SHORT: Duration = Duration::from_millis(2);

#[test]
fn changes_between_two_ticks_are_noticed_however_many_frames_pass() {
    let mut app = app_at(SHORT);
    let (vehicle, cloth) = attached(&mut app, false);
    let lorry = app.world_mut().spawn(Transform::from_xyz(0.35, 0.0, 0.0)).id();
    app.world_mut().entity_mut(vehicle).insert(ChildOf(lorry));
    let (lost, other) = attached(&mut app, false);
    let (_, released) = attached(&mut app, false);
    for frame in 0..8 {
        run(&mut app, 8 * LONG + frame);
        let tip = state(&app, cloth).positions()[16];
        let mut world = app.world_mut().entity_mut(vehicle);
        if frame % 2 == 0 {
            world.remove::<ChildOf>()
        } else {
            world.insert(ChildOf(lorry))
        };
        run(&mut app, 20);
        assert!(error(&app, vehicle, cloth) < TOLERANCE);
        let left_behind = state(&app, cloth).positions()[16].distance(tip);
        assert!(left_behind > FELT, "the frame has jumped: {left_behind} m");
    }
    app.world_mut().entity_mut(released).remove::<Attachment>();
    app.world_mut().despawn(lost);
    run(&mut app, 20);
    assert!(app.world().get::<ClothPaused>(other).is_some());
    let fabric = state(&app, released).fabric().expect("a fabric");
    assert!(!fabric.has_pins(), "it has let go");
}
