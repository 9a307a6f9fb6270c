//! Tests that targets and colliders may be moved by any schedule, at any speed.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::TransformSystems;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, FLAG, app, app_at, bits, greatest_speed, run, state};

/// An entity that moves by a course: its position at a time (s), m.
#[derive(Component)]
struct Moved(fn(f32) -> Vec3);

fn move_all(mut moved: Query<(&Moved, &mut Transform)>, time: Res<Time>) {
    for (moved, mut transform) in &mut moved {
        transform.translation = (moved.0)(time.elapsed_secs());
    }
}

/// Adds a system to the schedule that moves entities.
type Schedules = [(&'static str, fn(&mut App)); 10];

fn add(app: &mut App, schedule: impl ScheduleLabel) {
    app.add_systems(schedule, move_all);
}

const SCHEDULES: Schedules = [
    ("First", |app| add(app, First)),
    ("PreUpdate", |app| add(app, PreUpdate)),
    ("FixedFirst", |app| add(app, FixedFirst)),
    ("FixedUpdate", |app| add(app, FixedUpdate)),
    ("FixedLast", |app| add(app, FixedLast)),
    ("before the fixed loop", |app| {
        let before = RunFixedMainLoopSystems::BeforeFixedMainLoop;
        app.add_systems(RunFixedMainLoop, move_all.in_set(before));
    }),
    ("Update", |app| add(app, Update)),
    ("PostUpdate", |app| {
        app.add_systems(PostUpdate, move_all.before(TransformSystems::Propagate));
    }),
    ("PostUpdate, after the propagation", |app| {
        app.add_systems(PostUpdate, move_all.after(TransformSystems::Propagate));
    }),
    ("Last", |app| add(app, Last)),
];

fn rides<const SPEED: u32>(time: f32) -> Vec3 {
    Vec3::new(-(SPEED as f32) * (time - 1.0).max(0.0), 3.0, 0.0)
}

/// Flags on vehicles of several speeds, after three seconds.
fn flown(add: fn(&mut App), rate: f64, name: &str) -> Vec<Bits> {
    let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
    add(&mut app);
    let flags = [rides::<26>, rides::<40>, rides::<60>].map(|course| {
        let vehicle = app.world_mut().spawn((Moved(course), Transform::default())).id();
        app.world_mut().spawn((FLAG, Attachment::new(vehicle, ClothEdge::Left))).id()
    });
    run(&mut app, (3.0 * rate) as usize);
    let flown = flags.map(|flag| {
        let [corner, .., tip] = state(&app, flag).positions()[..17] else { panic!("a row") };
        assert_eq!(corner, Vec3::ZERO, "it is on its pole: {name} at {rate} Hz");
        assert!(tip.x > 1.2, "it streams: {tip}, {name} at {rate} Hz");
        bits(&app, flag)
    });
    flown.into()
}

#[test]
fn a_flag_flies_on_a_fast_vehicle_whatever_moves_it() {
    for rate in [30.0, 60.0, 144.0, 240.0] {
        let flown = SCHEDULES.map(|(name, add)| (name, flown(add, rate, name)));
        let of = |name: &str| {
            let found = flown.iter().find(|(it, _)| *it == name);
            &found.expect("a schedule").1
        };
        // Poses of the same times make the same motion.
        for (one, other) in [
            ("PreUpdate", "Update"),
            ("before the fixed loop", "Update"),
            ("PostUpdate", "Update"),
            ("PostUpdate, after the propagation", "Last"),
            ("FixedFirst", "FixedUpdate"),
        ] {
            assert_eq!(of(one), of(other), "{one} and {other} at {rate} Hz");
        }
    }
}

fn flies_through<const SPEED: u32>(time: f32) -> Vec3 {
    Vec3::new(0.5, 2.5, SPEED as f32 * (time - 1.5))
}

#[test]
fn a_fast_ball_pushes_a_sheet_whatever_moves_it() {
    for (name, add) in SCHEDULES {
        for rate in [30.0, 60.0, 144.0] {
            for course in [flies_through::<20>, flies_through::<30>, flies_through::<60>] {
                let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
                add(&mut app);
                let world = app.world_mut();
                let pole = Transform::from_xyz(0.0, 3.0, 0.0);
                let held = Attachment::in_place(ClothEdge::Top);
                let sheet = world.spawn((ClothMesh::grid(9, 9, 1.0, 1.0), held, pole)).id();
                let ball = ClothCollider { features: true, ..ClothCollider::ball(0.3) };
                world.spawn((Moved(course), ball, Transform::default()));
                let mut most = 0.0_f32;
                for _ in 0..(2.0 * rate) as usize {
                    run(&mut app, 1);
                    if !state(&app, sheet).positions().is_empty() {
                        most = most.max(greatest_speed(&app, sheet));
                    }
                }
                assert!(most > 5.0, "{most} m/s: {name} at {rate} Hz");
            }
        }
    }
}

fn jumps(time: f32) -> Vec3 {
    if time > 1.0 { Vec3::new(5.0, 3.0, -2.0) } else { 3.0 * Vec3::Y }
}

#[test]
fn a_jump_carries_the_cloth_along_whatever_moves_it() {
    for (name, add) in SCHEDULES {
        let mut app = app();
        add(&mut app);
        let flag = |app: &mut App| {
            let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
            let attachment = Attachment::new(pole, ClothEdge::Left);
            (pole, app.world_mut().spawn((FLAG, attachment)).id())
        };
        let (pole, moved) = flag(&mut app);
        let (_, other) = flag(&mut app);
        app.world_mut().entity_mut(pole).insert(Moved(jumps));
        run(&mut app, 128);
        let at = app.world().get::<GlobalTransform>(moved).expect("a transform").translation();
        assert_eq!(at, jumps(2.0), "{name}");
        assert_eq!(bits(&app, moved), bits(&app, other), "the jump changes no bit: {name}");
    }
}
