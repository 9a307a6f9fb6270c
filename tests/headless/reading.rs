//! Tests of reading a cloth: velocities, strains, tensions, and hits on its surface.

use bevy_app::{App, FixedUpdate};
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Isometry3d, Quat, Ray3d, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, TICK, app, bits, run, spawn_flag, state};
use parry3d::shape::{Ball, Cuboid, HalfSpace};

/// A square metre, whose mesh has its origin at the top left.
const SHEET: ClothMesh = ClothMesh::grid(17, 17, 1.0, 1.0);

/// Calls `ask` in a system.
fn ask<R: Send + 'static>(
    app: &mut App,
    ask: impl Fn(&mut ClothSpatialQuery) -> R + Send + Sync + 'static,
) -> R {
    let system = move |mut space: ClothSpatialQuery| ask(&mut space);
    app.world_mut().run_system_once(system).expect("a system that runs")
}

/// A sheet without gravity that stands still at a pose.
fn still(app: &mut App, pose: Transform) -> Entity {
    app.insert_resource(ClothSettings { gravity: Vec3::ZERO, ..ClothSettings::default() });
    let held = Attachment::in_place(ClothEdge::Top);
    app.world_mut().spawn((SHEET, held, ClothSeed(1), pose)).id()
}

#[test]
fn velocities_are_those_of_the_world_in_a_moving_frame() {
    let mut app = app();
    app.insert_resource(ClothSettings {
        gravity: Vec3::ZERO,
        air_density: 0.0,
        ..ClothSettings::default()
    });
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    // 3 m/s along the world's x, of a frame that turns meanwhile.
    let pose = |at: f32| Transform::from_xyz(at, 0.0, 0.0).with_rotation(Quat::from_rotation_y(at));
    let travel = move |mut poses: Query<&mut Transform, With<ClothMesh>>, mut at: Local<f32>| {
        *at += 3.0 * TICK;
        poses.iter_mut().for_each(|mut it| *it = pose(*at));
    };
    app.add_systems(FixedUpdate, travel);
    run(&mut app, 200);
    let now = *app.world().get::<Transform>(flag).expect("a pose");
    let before = pose(now.translation.x - 3.0 * TICK);
    let state = state(&app, flag);
    let velocities: Vec<Vec3> = state.velocities().map(|it| now.rotation * it).collect();
    for (particle, velocity) in velocities.iter().enumerate() {
        let way = now.transform_point(state.positions()[particle])
            - before.transform_point(state.previous_positions()[particle]);
        assert!(velocity.distance(way / TICK) < 1e-2, "{particle}: {velocity}");
    }
    // The first particle is at the origin of the frame.
    assert!(velocities[0].distance(3.0 * Vec3::X) < 1e-2, "{}", velocities[0]);
    assert_eq!(state.velocity(1_000_000), Vec3::ZERO);
}

#[test]
fn what_falls_has_the_velocity_of_its_fall_and_what_is_paused_none() {
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    let weightless = FabricMaterial { damping: 0.0, ..FabricMaterial::SILK };
    let cloth = app.world_mut().spawn((FLAG, ClothMaterial(weightless))).id();
    run(&mut app, 33);
    // The mean over the last of 32 ticks is that in its middle.
    let due = -9.81 * 31.5 * TICK;
    let fall = |app: &App| state(app, cloth).velocities().map(|it| it.y).collect::<Vec<_>>();
    assert!(
        fall(&app).iter().all(|speed| (speed / due - 1.0).abs() < 0.01),
        "{due} {:?}",
        fall(&app)
    );
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    run(&mut app, 2);
    assert!(fall(&app).iter().all(|speed| *speed == 0.0));
}

#[test]
fn tension_at_the_top_of_a_hanging_sheet_carries_its_weight() {
    let mut app = app();
    let hung = Attachment::in_place(ClothEdge::Top);
    let cloth = app.world_mut().spawn((SHEET, hung)).id();
    run(&mut app, 400);
    let material = ClothMaterial::default().0;
    let state = state(&app, cloth);
    let links = state.fabric().expect("a fabric").links();
    assert_eq!(links.len(), state.strains().count());
    let under_top = |link: &bevy_bunting::bunting_solver::Link| {
        let [from, to] = link.particles;
        from / 17 == 0 && to / 17 == 1 && from % 17 == to % 17
    };
    let tensions = links.iter().zip(state.tensions(&material));
    let of_top: Vec<f32> = tensions.filter(|it| under_top(it.0)).map(|it| it.1).collect();
    assert_eq!(of_top.len(), 17);
    let mean = of_top.iter().sum::<f32>() / 17.0;
    // A metre of cloth hangs below, less half a row.
    let weight = 9.81 * material.area_density * (1.0 - 0.5 / 16.0);
    assert!((mean / weight - 1.0).abs() < 0.05, "{mean} N/m carry {weight} N/m");
    let rigid =
        FabricMaterial { warp_stiffness: f32::INFINITY, weft_stiffness: f32::INFINITY, ..material };
    assert!(state.tensions(&rigid).all(|tension| tension == 0.0));
}

#[test]
fn a_ray_finds_the_first_cloth_in_its_way() {
    let mut app = app();
    let far = still(&mut app, Transform::from_xyz(0.0, 0.0, -2.0));
    let turned = Quat::from_rotation_y(core::f32::consts::PI);
    let near = still(&mut app, Transform::from_xyz(1.0, 0.0, -1.0).with_rotation(turned));
    run(&mut app, 10);
    let from = Vec3::new(0.3, -0.4, 1.0);
    let ray = Ray3d::new(from, Dir3::NEG_Z);
    let hit = ask(&mut app, move |space| space.cast_ray(ray, 10.0, |_| true)).expect("a hit");
    assert_eq!(hit.entity, near);
    assert!((hit.distance - 2.0).abs() < 0.01 && hit.normal.distance(Vec3::Z) < 0.1, "{hit:?}");
    assert!(hit.point.distance(Vec3::new(0.3, -0.4, -1.0)) < 0.01, "{hit:?}");
    // The particles with their weights are at the same place.
    let at = |particle: u32| state(&app, near).positions()[particle as usize];
    let place: Vec3 =
        hit.particles.map(at).into_iter().zip(hit.weights).map(|(at, w)| at * w).sum();
    let frame = Isometry3d::new(Vec3::new(1.0, 0.0, -1.0), turned);
    assert!((frame * place).distance(hit.point) < 1e-4, "{place}");
    let behind = ask(&mut app, move |space| space.cast_ray(ray, 10.0, move |it| it != near));
    assert_eq!(behind.map(|hit| hit.entity), Some(far));
    for (ray, within) in [
        (ray, 1.9),
        (Ray3d::new(from, Dir3::Z), 10.0),
        (Ray3d::new(from + 3.0 * Vec3::X, Dir3::NEG_Z), 10.0),
        (Ray3d::new(Vec3::NAN, Dir3::NEG_Z), 10.0),
        (ray, f32::NAN),
    ] {
        let hit = ask(&mut app, move |space| space.cast_ray(ray, within, |_| true));
        assert_eq!(hit, None, "{ray:?} {within}");
    }
}

#[test]
fn the_nearest_point_lies_on_the_sheet_or_on_its_border() {
    let mut app = app();
    let sheet = still(&mut app, Transform::from_xyz(5.0, 1.0, 0.0));
    run(&mut app, 10);
    let mut nearest = |to: Vec3, within: f32| {
        ask(&mut app, move |space| space.nearest_point(to, within, |_| true))
    };
    let before = nearest(Vec3::new(5.4, 0.5, 0.7), 1.0).expect("a point");
    assert_eq!(before.entity, sheet);
    assert!((before.distance - 0.7).abs() < 0.01 && before.normal.z > 0.9, "{before:?}");
    let beside = nearest(Vec3::new(4.0, 0.5, 0.0), 2.0).expect("a point");
    assert!(beside.point.distance(Vec3::new(5.0, 0.5, 0.0)) < 0.01, "{beside:?}");
    assert!((beside.weights.iter().sum::<f32>() - 1.0).abs() < 1e-4);
    assert_eq!(nearest(Vec3::new(4.0, 0.5, 0.0), 0.9), None);
    assert_eq!(nearest(Vec3::NAN, 9.0), None);
}

#[test]
fn shapes_overlap_the_cloths_that_they_cut() {
    let mut app = app();
    let [left, right] = [0.0, 3.0].map(|x| still(&mut app, Transform::from_xyz(x, 0.0, 0.0)));
    run(&mut app, 10);
    let at = |x: f32, z: f32| Isometry3d::from_translation(Vec3::new(x, -0.5, z));
    let balls = [(0.5, 0.2, vec![left]), (3.5, 0.2, vec![right]), (0.5, 0.4, vec![])];
    for (x, z, due) in balls {
        let found =
            ask(&mut app, move |space| space.overlapping(&Ball::new(0.3), at(x, z), |_| true));
        assert_eq!(found, due, "a ball at {x} {z}");
    }
    let wide = Cuboid::new(Vec3::new(5.0, 0.1, 0.1));
    let found = ask(&mut app, move |space| space.overlapping(&wide, at(0.0, 0.0), |_| true));
    assert_eq!(found, [left, right]);
    // It contains the whole sheet, without cutting it anywhere.
    let large = Ball::new(2.0);
    let found =
        ask(&mut app, move |space| space.overlapping(&large, at(0.5, 0.0), move |it| it == left));
    assert_eq!(found, [left]);
    let below = HalfSpace::new(Vec3::Y);
    let found = ask(&mut app, move |space| {
        space.overlapping(&below, Isometry3d::from_translation(-2.0 * Vec3::Y), |_| true)
    });
    assert_eq!(found, []);
}

#[test]
fn reading_wakes_nothing_and_changes_no_bit() {
    let read = |reads: bool| {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        app.world_mut().resource_mut::<ClothSettings>().gravity = Vec3::ZERO;
        if reads {
            let system = |cloths: Query<&ClothState>, mut space: ClothSpatialQuery| {
                let material = FabricMaterial::SILK;
                for state in &cloths {
                    let sum: Vec3 = state.velocities().sum();
                    let tension: f32 = state.tensions(&material).sum();
                    assert!(sum.is_finite() && tension.is_finite());
                }
                let _ = space.nearest_point(Vec3::ZERO, 9.0, |_| true);
            };
            app.add_systems(FixedUpdate, system);
        }
        run(&mut app, 300);
        (state(&app, flag).activity(), bits(&app, flag))
    };
    let (asleep, unread) = read(false);
    assert_eq!(asleep, ClothActivity::AtRest);
    assert_eq!(read(true), (asleep, unread));
}

#[test]
fn hits_follow_a_cloth_that_moves_asleep_and_forget_one_that_is_gone() {
    let mut app = app();
    let sheet = still(&mut app, Transform::IDENTITY);
    run(&mut app, 5);
    app.world_mut().entity_mut(sheet).insert(ClothPaused);
    run(&mut app, 5);
    let ray = |x: f32| Ray3d::new(Vec3::new(x + 0.5, -0.5, 1.0), Dir3::NEG_Z);
    let hits = |app: &mut App, x: f32| {
        ask(app, move |space| space.cast_ray(ray(x), 9.0, |_| true)).is_some()
    };
    assert_eq!([0.0, 20.0].map(|x| hits(&mut app, x)), [true, false]);
    app.world_mut().entity_mut(sheet).insert(Transform::from_xyz(20.0, 0.0, 0.0));
    run(&mut app, 3);
    assert_eq!([0.0, 20.0].map(|x| hits(&mut app, x)), [false, true]);
    app.world_mut().despawn(sheet);
    assert!(!hits(&mut app, 20.0));
}
