//! Tests of cloths that are spawned, changed, paused and despawned while the app runs.

use std::time::Duration;

use bevy_app::FixedUpdate;
use bevy_app::Update;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, ClothCounts, ClothTimings};
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{
    FLAG, Seen, TICK, app, app_at, assert_finite, bits, greatest, greatest_speed, run, spawn_flag,
    state,
};

#[test]
fn a_mesh_alone_is_a_working_cloth() {
    let mut app = app();
    let cloth = app.world_mut().spawn(ClothMesh::grid(5, 5, 1.0, 1.0)).id();
    run(&mut app, 33);
    assert_finite(&app, cloth);
    let fall = state(&app, cloth).positions()[12].y + 0.5;
    assert!(fall < -0.3, "half a second of free fall in air is more than {fall} m");
}

#[test]
fn spawn_change_and_despawn_while_running() {
    let mut app = app();
    let first = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 10);
    let second = spawn_flag(&mut app, Vec3::X);
    run(&mut app, 10);
    assert_finite(&app, first);
    assert_finite(&app, second);
    assert_eq!(app.world().resource::<ClothCounts>().0, [2]);
    let others = [(); 2].map(|()| spawn_flag(&mut app, Vec3::Y));
    run(&mut app, 1);
    assert_eq!(app.world().resource::<ClothBatches>().batch_count(), 1);
    others.into_iter().for_each(|other| assert!(app.world_mut().despawn(other)));
    run(&mut app, 1);
    assert_eq!(
        app.world().resource::<ClothBatches>().batch_count(),
        2,
        "two cloths are faster in a batch each"
    );

    app.world_mut().entity_mut(first).insert(ClothMesh::grid(9, 9, 1.0, 1.0));
    run(&mut app, 10);
    assert_eq!(state(&app, first).positions().len(), 81);
    assert_eq!(app.world().resource::<ClothBatches>().batch_count(), 2);

    app.world_mut().despawn(first);
    run(&mut app, 1);
    assert_eq!(app.world().resource::<ClothBatches>().batch_count(), 1);
    app.world_mut().entity_mut(second).remove::<ClothMesh>();
    run(&mut app, 1);
    assert_eq!(app.world().resource::<ClothBatches>().batch_count(), 0);
    assert!(state(&app, second).positions().is_empty());

    app.world_mut().entity_mut(second).insert(FLAG);
    run(&mut app, 2);
    assert_finite(&app, second);
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

#[test]
fn a_material_may_change_while_running() {
    let mut app = app();
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    let other = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 20);
    assert_eq!(bits(&app, cloth), bits(&app, other));
    app.world_mut().entity_mut(cloth).insert(ClothMaterial::DENIM);
    run(&mut app, 20);
    assert_ne!(bits(&app, cloth), bits(&app, other));
    assert_finite(&app, cloth);
}

#[test]
fn removing_the_attachment_keeps_the_shape() {
    let mut app = app();
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 60);
    let before = state(&app, cloth).positions().to_vec();
    let speed = greatest_speed(&app, cloth);
    app.world_mut().entity_mut(cloth).remove::<Attachment>();
    run(&mut app, 1);
    let moved =
        state(&app, cloth).positions().iter().zip(&before).map(|(now, then)| now.distance(*then));
    let moved = greatest(moved);
    assert!(moved < 2.0 * (speed + 1.0) * TICK, "{moved} m in a tick");
    run(&mut app, 60);
    assert!(state(&app, cloth).positions()[0].y < -1.0, "it falls");
}

#[test]
fn a_pause_changes_no_bit() {
    let mut app = app();
    let paused = spawn_flag(&mut app, Vec3::ZERO);
    let other = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 30);
    app.world_mut().entity_mut(paused).insert(ClothPaused);
    let before = bits(&app, paused);
    run(&mut app, 1);
    let ahead = bits(&app, other);
    run(&mut app, 50);
    assert_eq!(bits(&app, paused), before);
    assert_eq!(greatest_speed(&app, paused), 0.0);
    assert_ne!(bits(&app, other), before);
    app.world_mut().entity_mut(paused).remove::<ClothPaused>();
    run(&mut app, 1);
    assert_eq!(bits(&app, paused), ahead, "the pause changed it");
}

#[test]
fn the_surface_is_interpolated_by_the_overstep() {
    // Three frames pass in the time of four ticks.
    let mut app = app_at(Duration::from_secs_f64(4.0 / 3.0 / 64.0));
    let cloth =
        app.world_mut().spawn((ClothMesh::grid(3, 3, 1.0, 1.0), ClothSurface::default())).id();
    let mut speeds = Vec::new();
    let mut last: Option<f32> = None;
    for _ in 0..30 {
        app.update();
        let surface = app.world().get::<ClothSurface>(cloth).expect("a surface");
        let Some(&position) = surface.positions.get(4) else { continue };
        if let Some(last) = last {
            speeds.push(last - position.y);
        }
        last = Some(position.y);
    }
    // The speed of a falling cloth grows steadily from frame to frame; without interpolation it would double
    // in each frame that shows two ticks.
    let gains: Vec<f32> = speeds.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gains.len() > 20, "{}", gains.len());
    assert!(gains[3..].iter().all(|gain| (-1e-4..0.006).contains(gain)), "{gains:?}");
}

#[test]
fn other_schedules_may_host_the_tick() {
    let mut app = bevy_app::App::new();
    app.add_plugins((bevy_time::TimePlugin, TransformPlugin, ClothPlugins::new(Update)))
        .insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(Duration::from_millis(10)))
        .add_systems(FixedUpdate, || {});
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 20);
    assert_finite(&app, cloth);
    assert_ne!(state(&app, cloth).positions()[16], Vec3::new(1.5, 0.0, 0.0));
    assert!(!app.world().resource::<ClothTimings>().total().is_zero());
}
