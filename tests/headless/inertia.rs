//! Tests of the part of its frame's acceleration that a cloth feels.

use bevy_app::prelude::*;
use bevy_bunting::ClothEffort;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{
    Bits, Seen, TICK, app, assert_finite, bits, greatest, greatest_speed, run, state,
};

/// Cotton that comes to rest.
const DAMPED: ClothMaterial =
    ClothMaterial(FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON });

/// Ticks in which it comes to rest.
const SETTLING: usize = 64 * 10;

/// A curtain on a frame whose pose is a function of time (s), in air or in a vacuum.
fn curtain(in_air: bool, pose: impl Fn(f32) -> Transform + Send + Sync + 'static) -> (App, Entity) {
    let mut app = app();
    if !in_air {
        app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    }
    let frame = app.world_mut().spawn(pose(0.0)).id();
    app.add_systems(FixedUpdate, move |mut all: Query<&mut Transform>, time: Res<Time>| {
        *all.get_mut(frame).expect("a frame") = pose(time.elapsed_secs());
    });
    let held = Attachment::new(frame, ClothEdge::Top);
    let curtain = app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), DAMPED, held)).id();
    (app, curtain)
}

/// Positions of a curtain that feels these parts, after some ticks, m.
fn after(
    ticks: usize,
    inertia: ClothInertia,
    in_air: bool,
    pose: impl Fn(f32) -> Transform + Send + Sync + 'static,
) -> Vec<Vec3> {
    let (mut app, cloth) = curtain(in_air, pose);
    app.world_mut().entity_mut(cloth).insert(inertia);
    run(&mut app, ticks);
    assert_finite(&app, cloth);
    state(&app, cloth).positions().to_vec()
}

/// Greatest distance of two particles with one index, m.
fn apart(one: &[Vec3], other: &[Vec3]) -> f32 {
    greatest(one.iter().zip(other).map(|(a, b)| a.distance(*b)))
}

fn still(_: f32) -> Transform {
    Transform::default()
}

/// A dash of 20 m/s in a quarter of a second.
fn dash(time: f32) -> Transform {
    let since = (time - 0.5).max(0.0);
    let way = if since < 0.25 { 40.0 * since * since } else { 20.0 * (since - 0.125) };
    Transform::from_xyz(0.0, 0.0, way)
}

/// A spin about an axis beside the curtain, at 6 rad/s.
fn spin(time: f32) -> Transform {
    Transform::from_rotation(Quat::from_rotation_y(6.0 * time))
}

#[test]
fn by_default_cloth_feels_everything() {
    let flown = |inertia: Option<ClothInertia>| -> Bits {
        let shaken = |time: f32| {
            Transform::from_xyz(time.sin(), 0.0, (3.0 * time).cos())
                .with_rotation(Quat::from_rotation_y((2.0 * time).sin()))
        };
        let (mut app, cloth) = curtain(true, shaken);
        if let Some(inertia) = inertia {
            app.world_mut().entity_mut(cloth).insert(inertia);
        }
        run(&mut app, 100);
        bits(&app, cloth)
    };
    let natural = flown(None);
    assert_eq!(flown(Some(ClothInertia::default())), natural);
    assert_ne!(flown(Some(ClothInertia::new(0.5, 1.0))), natural);
    assert_ne!(flown(Some(ClothInertia::new(1.0, 0.5))), natural);
}

#[test]
fn a_dash_that_is_not_felt_does_not_swing_the_cloth() {
    let calm = after(60, ClothInertia::default(), false, still);
    let swung = after(60, ClothInertia::default(), false, dash);
    assert!(apart(&swung, &calm) > 0.5, "{} m", apart(&swung, &calm));
    let unfelt = after(60, ClothInertia::new(0.0, 1.0), false, dash);
    assert!(apart(&unfelt, &calm) < 1e-3, "{} m", apart(&unfelt, &calm));
}

#[test]
fn the_felt_part_of_an_acceleration_acts_like_gravity() {
    // Speeds up by 6 m/s².
    let speeds_up = |time: f32| Transform::from_xyz(0.0, 0.0, 3.0 * time * time);
    for part in [0.5, 1.0] {
        let felt = after(SETTLING, ClothInertia::new(part, 1.0), false, speeds_up);
        let (mut app, cloth) = curtain(false, still);
        app.world_mut().entity_mut(cloth).insert(ClothAcceleration(Vec3::Z * (-6.0 * part)));
        run(&mut app, SETTLING);
        let tilted = state(&app, cloth).positions();
        assert!(apart(&felt, tilted) < 5e-3, "{} m at {part}", apart(&felt, tilted));
        assert!(felt[76].z < -0.2, "{}", felt[76]);
    }
}

#[test]
fn a_spin_that_is_not_felt_does_not_fling_the_cloth() {
    let calm = after(SETTLING, ClothInertia::default(), false, still);
    let flung = after(SETTLING, ClothInertia::default(), false, spin);
    assert!(apart(&flung, &calm) > 0.1, "{} m", apart(&flung, &calm));
    let unfelt = after(SETTLING, ClothInertia::new(1.0, 0.0), false, spin);
    assert!(apart(&unfelt, &calm) < 1e-3, "{} m", apart(&unfelt, &calm));
}

#[test]
fn a_circling_frame_is_felt_without_its_turn() {
    // Centripetal acceleration of 6.4 m/s² towards −z.
    let circles = |time: f32| {
        let turned = Quat::from_rotation_y(0.8 * time);
        Transform::from_translation(turned * Vec3::Z * 10.0).with_rotation(turned)
    };
    let felt = after(SETTLING, ClothInertia::new(1.0, 0.0), false, circles);
    let (mut app, cloth) = curtain(false, still);
    app.world_mut().entity_mut(cloth).insert(ClothAcceleration(Vec3::Z * 6.4));
    run(&mut app, SETTLING);
    let thrown = state(&app, cloth).positions();
    assert!(apart(&felt, thrown) < 5e-3, "{} m", apart(&felt, thrown));
    assert!(felt[76].z > 0.5, "{}", felt[76]);
}

#[test]
fn the_wind_of_a_ride_is_felt_in_any_case() {
    let rides = |time: f32| Transform::from_xyz(0.0, 0.0, 8.0 * time);
    let [natural, unfelt] =
        [1.0, 0.0].map(|part| after(SETTLING, ClothInertia::new(part, 1.0), true, rides));
    for (name, positions) in [("natural", natural), ("unfelt", unfelt)] {
        let bottom = greatest(positions[72..].iter().map(|at| -at.z));
        assert!(bottom > 0.3, "{name}: {bottom} m");
    }
}

#[test]
fn a_change_of_inertia_does_not_jolt_the_cloth() {
    let rides = |time: f32| Transform::from_xyz(0.0, 0.0, 20.0 * time);
    let spins = |time: f32| spin(time);
    let speeds = |pose: fn(f32) -> Transform, inertia: ClothInertia| {
        let (mut app, cloth) = curtain(false, pose);
        run(&mut app, SETTLING);
        app.world_mut().entity_mut(cloth).insert(inertia);
        run(&mut app, 1);
        let there = greatest_speed(&app, cloth);
        run(&mut app, SETTLING);
        app.world_mut().entity_mut(cloth).remove::<ClothInertia>();
        run(&mut app, 1);
        [there, greatest_speed(&app, cloth)]
    };
    for speed in speeds(rides, ClothInertia::new(0.0, 1.0)) {
        assert!(speed < 0.05, "{speed} m/s of 20");
    }
    // At 6 rad/s, the forces on a particle a metre from the axis change by 36 m/s².
    for speed in speeds(spins, ClothInertia::new(1.0, 0.0)) {
        assert!(speed < 40.0 * TICK, "{speed} m/s of 6");
    }
}

#[test]
fn what_is_not_felt_takes_no_substeps() {
    let effort = |part: f32| {
        let (mut app, cloth) = curtain(false, dash);
        app.world_mut().entity_mut(cloth).insert(ClothInertia::new(part, part));
        run(&mut app, 45);
        let effort = app.world().get::<ClothEffort>(cloth).expect("an effort");
        (effort.loads().frame, effort.settings().substeps)
    };
    let [(felt, most), (unfelt, fewest)] = [1.0, 0.0].map(effort);
    // The dash speeds up by 80 m/s².
    assert!((felt - 80.0).abs() < 1.0 && unfelt == 0.0, "{felt} and {unfelt} m/s²");
    assert!(most > fewest, "{most} and {fewest} substeps");
}

#[test]
fn accelerations_are_felt_up_to_their_limit() {
    // Speeds up by 12 m/s².
    let speeds_up = |time: f32| Transform::from_xyz(0.0, 0.0, 6.0 * time * time);
    let limited = ClothInertia { max_acceleration: 6.0, ..ClothInertia::default() };
    let felt = after(SETTLING, limited, false, speeds_up);
    let (mut app, cloth) = curtain(false, still);
    app.world_mut().entity_mut(cloth).insert(ClothAcceleration(Vec3::Z * -6.0));
    run(&mut app, SETTLING);
    let tilted = state(&app, cloth).positions();
    assert!(apart(&felt, tilted) < 5e-3, "{} m", apart(&felt, tilted));
    assert!(felt[76].z < -0.2, "{}", felt[76]);
}

#[test]
fn speeds_are_felt_up_to_their_limit_as_wind_and_as_they_change() {
    let rides = |speed: f32| move |time: f32| Transform::from_xyz(0.0, 0.0, speed * time);
    let no_faster_than = |max_speed: f32| ClothInertia { max_speed, ..ClothInertia::default() };
    let calm = after(SETTLING, ClothInertia::default(), true, still);
    let shut = after(SETTLING, no_faster_than(0.0), true, rides(20.0));
    assert!(apart(&shut, &calm) < 1e-3, "{} m", apart(&shut, &calm));
    // At half a metre a second the curtain leans and does not flutter.
    let slow = after(SETTLING, no_faster_than(f32::MAX), true, rides(0.5));
    let limited = after(SETTLING, no_faster_than(0.5), true, rides(20.0));
    assert!(apart(&limited, &slow) < 0.01, "{} m", apart(&limited, &slow));
    assert!(apart(&slow, &calm) > 0.025, "{} m", apart(&slow, &calm));
    // Of the dash from 0 to 20 m/s, only the first metre a second is felt.
    let calm = after(60, ClothInertia::default(), false, still);
    let dashed = after(60, no_faster_than(1.0), false, dash);
    let natural = after(60, ClothInertia::default(), false, dash);
    let [dashed, natural] = [dashed, natural].map(|positions| apart(&positions, &calm));
    assert!(dashed < 0.3 && natural > 0.5, "{dashed} and {natural} m");
}

#[test]
fn turns_are_felt_up_to_their_limit() {
    let limited = ClothInertia { max_turn_rate: 4.0, ..ClothInertia::default() };
    let felt = after(SETTLING, limited, false, spin);
    let slower = |time: f32| Transform::from_rotation(Quat::from_rotation_y(4.0 * time));
    let slow = after(SETTLING, ClothInertia::default(), false, slower);
    assert!(apart(&felt, &slow) < 1e-3, "{} m", apart(&felt, &slow));
    let calm = after(SETTLING, ClothInertia::default(), false, still);
    assert!(apart(&slow, &calm) > 5e-3, "{} m", apart(&slow, &calm));
}

#[test]
fn what_exceeds_a_limit_takes_no_substeps() {
    let load = |inertia: ClothInertia| {
        let (mut app, cloth) = curtain(false, dash);
        app.world_mut().entity_mut(cloth).insert(inertia);
        run(&mut app, 45);
        app.world().get::<ClothEffort>(cloth).expect("an effort").loads().frame
    };
    // The dash speeds up by 80 m/s².
    let limited = load(ClothInertia { max_acceleration: 6.0, ..ClothInertia::default() });
    assert!((limited - 6.0).abs() < 0.1, "{limited} m/s²");
    let slow = load(ClothInertia { max_speed: 1.0, ..ClothInertia::default() });
    assert!(slow < 0.1, "{slow} m/s²");
}

#[test]
fn bad_parts_are_reported_and_everything_is_felt() {
    let limited = |max_speed: f32| ClothInertia { max_speed, ..ClothInertia::default() };
    let bad = [
        ClothInertia::new(f32::NAN, 1.0),
        ClothInertia::new(1.0, 1.5),
        limited(-1.0),
        limited(f32::NAN),
    ];
    for bad in bad {
        let flown = |inertia: Option<ClothInertia>| {
            let (mut app, cloth) = curtain(true, dash);
            if let Some(inertia) = inertia {
                app.world_mut().entity_mut(cloth).insert(inertia);
            }
            run(&mut app, 60);
            (bits(&app, cloth), app, cloth)
        };
        let (natural, ..) = flown(None);
        let (bits, app, cloth) = flown(Some(bad));
        assert_eq!(bits, natural);
        let failed = &app.world().resource::<Seen<ClothFailed>>().0;
        let [ClothFailed { entity, error }] = failed[..] else { panic!("{failed:?}") };
        assert_eq!((entity, error), (cloth, ClothError::Inertia { entity: cloth }));
    }
}
