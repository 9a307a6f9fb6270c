//! Bad input is reported, and names the entity.

use avian3d::prelude::*;
use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::{ClothColliderError, ClothColliderFailed};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, bits, run, spawn_flag};

use crate::{SECOND, app, middle, sheet};

fn failures(app: &App) -> &[ClothColliderFailed] {
    &app.world().resource::<Seen<ClothColliderFailed>>().0
}

/// Reports that a collider causes. A flag beside it has the bits that it has without it.
fn reported(spawn: impl FnOnce(&mut App) -> Entity) -> (Entity, Vec<ClothColliderFailed>) {
    let flag_beside = |spawn: Option<Box<dyn FnOnce(&mut App) -> Entity + '_>>| {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::new(20.0, 0.0, 0.0));
        let collider = spawn.map(|spawn| spawn(&mut app));
        run(&mut app, 30);
        (collider, failures(&app).to_vec(), bits(&app, flag))
    };
    let (_, none, alone) = flag_beside(None);
    let (collider, reports, beside) = flag_beside(Some(Box::new(spawn)));
    assert_eq!((none.len(), beside), (0, alone));
    (collider.expect("a collider"), reports)
}

#[test]
fn shapes_without_a_surface_are_reported_once() {
    let shapes = [
        Collider::segment(Vec3::NEG_X, Vec3::X),
        Collider::polyline(vec![Vec3::NEG_X, Vec3::ZERO, Vec3::X], None),
    ];
    for shape in shapes {
        let kind = shape.shape().shape_type();
        let spawn = |app: &mut App| app.world_mut().spawn((shape, Transform::default())).id();
        let (entity, reports) = reported(spawn);
        let error = ClothColliderError::Shape { entity, shape: kind };
        assert_eq!(reports, [ClothColliderFailed { entity, error }]);
        assert!(error.to_string().contains(&entity.to_string()));
    }
}

#[test]
fn a_refused_collider_that_gets_another_shape_is_felt() {
    let mut app = app();
    let segment = Collider::segment(Vec3::NEG_X, Vec3::X);
    let body = app.world_mut().spawn((segment, Transform::default())).id();
    run(&mut app, 3);
    assert!(app.world().get::<ClothCollider>(body).is_none());
    app.world_mut().entity_mut(body).insert(Collider::sphere(0.5));
    let cloth = app.world_mut().spawn(sheet(1.0)).id();
    run(&mut app, 4 * SECOND);
    assert_eq!(failures(&app).len(), 1);
    assert!(middle(&app, cloth).y > -1.5);
    // The other way round, the collider that it was is forgotten.
    app.world_mut().entity_mut(body).insert(Collider::segment(Vec3::NEG_X, Vec3::X));
    run(&mut app, 2);
    assert_eq!(failures(&app).len(), 2);
    assert!(app.world().get::<ClothCollider>(body).is_none());
}

#[test]
fn a_pose_that_is_not_finite_is_reported_and_is_not_at_the_origin() {
    let nan = Transform::from_xyz(0.0, f32::NAN, 0.0);
    let spawn = |app: &mut App| app.world_mut().spawn((Collider::sphere(0.5), nan)).id();
    let (entity, reports) = reported(spawn);
    let error = ClothColliderError::Pose { entity };
    assert_eq!(reports, [ClothColliderFailed { entity, error }]);
    assert!(error.to_string().contains(&entity.to_string()));
}
