//! Item 3: flat cloth leaves its plane.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, run, spawn_flag, state};

use super::strain;

/// Least distance of a fold from the cloth's plane, m.
const FOLD: f32 = 0.02;

/// Greatest distance of a newly spawned cloth from its plane, m.
const IMPERCEPTIBLE: f32 = 2e-4;

/// Distance that a cloth reaches out of its plane, m.
fn depth(app: &App, cloth: Entity) -> f32 {
    state(app, cloth).positions().iter().map(|position| position.z.abs()).fold(0.0, f32::max)
}

#[test]
fn a_flag_without_wind_folds() {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 2);
    assert!(depth(&app, flag) < IMPERCEPTIBLE, "{} m at first", depth(&app, flag));
    run(&mut app, 64);
    assert!(depth(&app, flag) > FOLD, "{} m out of the plane after a second", depth(&app, flag));
}

#[test]
fn a_flag_ahead_of_its_pole_turns_round() {
    let mut app = app();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let flag = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
    app.add_systems(FixedUpdate, move |mut poles: Query<&mut Transform>, time: Res<Time>| {
        poles.get_mut(pole).expect("it stays").translation.x += 20.0 * time.delta_secs();
    });
    run(&mut app, 64 * 3);
    let mean = (0..64).map(|_| {
        app.update();
        strain(&app, flag).mean
    });
    let mean = mean.sum::<f32>() / 64.0;
    assert!(mean < 0.02, "mean strain {mean}");
    assert!(depth(&app, flag) > FOLD, "{} m", depth(&app, flag));
}

#[test]
fn a_sheet_on_the_floor_lies_flat_and_sleeps() {
    let mut app = app();
    let flat = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    let place = Transform::from_xyz(0.0, 0.02, 0.0).with_rotation(flat);
    let sheet = app.world_mut().spawn((ClothMesh::grid(17, 17, 1.0, 1.0), place)).id();
    app.world_mut().spawn((ClothCollider::ground(), Transform::default()));
    run(&mut app, 64 * 5);
    assert_eq!(state(&app, sheet).activity(), ClothActivity::AtRest);
    let thickness = FabricMaterial::FLAG_POLYESTER.thickness;
    let lifted = state(&app, sheet).positions().iter().map(|at| at.z + 0.02 - thickness);
    let lifted = lifted.fold(0.0, f32::max);
    assert!(lifted < 1e-3, "{lifted} m above the floor");
}
