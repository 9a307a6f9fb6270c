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

/// Reports of a collider, which a flag beside it does not notice: it has the bits that it has alone.
fn reported(collider: impl Bundle) -> (Entity, Vec<ClothColliderFailed>) {
    let flag = |app: &mut App| spawn_flag(app, Vec3::new(20.0, 0.0, 0.0));
    let (mut alone, mut beside) = (app(), app());
    let flags = [flag(&mut alone), flag(&mut beside)];
    let collider = beside.world_mut().spawn(collider).id();
    run(&mut alone, 30);
    run(&mut beside, 30);
    assert_eq!(bits(&beside, flags[1]), bits(&alone, flags[0]));
    (collider, failures(&beside).to_vec())
}

#[test]
fn shapes_without_a_surface_are_reported_once() {
    let shapes = [
        Collider::segment(Vec3::NEG_X, Vec3::X),
        Collider::polyline(vec![Vec3::NEG_X, Vec3::ZERO, Vec3::X], None),
    ];
    for shape in shapes {
        let kind = shape.shape().shape_type();
        let (entity, reports) = reported((shape, Transform::default()));
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
    let (entity, reports) = reported((Collider::sphere(0.5), nan));
    let error = ClothColliderError::Pose { entity };
    assert_eq!(reports, [ClothColliderFailed { entity, error }]);
    assert!(error.to_string().contains(&entity.to_string()));
}

#[test]
fn a_pose_that_ceases_to_be_finite_is_reported_each_time_and_the_collider_stays() {
    let mut app = app();
    let ball = (Collider::sphere(0.5), Transform::default());
    let ball = app.world_mut().spawn(ball).id();
    let cloth = app.world_mut().spawn(sheet(1.0)).id();
    run(&mut app, 4 * SECOND);
    for times in 1..=2 {
        app.world_mut().entity_mut(ball).insert(Transform::from_xyz(f32::NAN, 0.0, 0.0));
        run(&mut app, SECOND);
        let error = ClothColliderError::Pose { entity: ball };
        assert_eq!(failures(&app), vec![ClothColliderFailed { entity: ball, error }; times]);
        assert!(middle(&app, cloth).y > -1.5);
        app.world_mut().entity_mut(ball).insert(Transform::default());
        run(&mut app, 10);
    }
}
