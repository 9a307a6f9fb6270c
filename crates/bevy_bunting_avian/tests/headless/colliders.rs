//! Avian's colliders are the cloth's: added, changed and removed.

use avian3d::prelude::*;
use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::run;

use crate::{SECOND, app, middle, places, position, sheet};

/// Greatest depth to which particles may be in a shape, m.
const DEPTH: f32 = 1e-3;

/// Height of the sheets that fall, and the height above which a sheet is that lies on a shape, m.
const HIGH: f32 = 1.0;
const CARRIED: f32 = -1.5;

/// Updates in which a sheet falls far below that height.
const FALL: usize = 4 * SECOND;

fn spawn_collider(app: &mut App, collider: Collider) -> Entity {
    app.world_mut().spawn((RigidBody::Static, collider, Transform::default())).id()
}

fn cloth_collider(app: &App, entity: Entity) -> Option<&ClothCollider> {
    app.world().get(entity)
}

/// Friction of a collider of cloth.
fn friction(app: &App, entity: Entity) -> f32 {
    cloth_collider(app, entity).expect("a collider of cloth").friction
}

#[test]
fn cloth_lies_on_shapes_of_every_kind() {
    let ground = |across: usize| vec![vec![0.0; across]; across];
    let corners = Collider::cuboid(1.0, 1.0, 1.0).shape().as_cuboid().expect("a box").to_trimesh();
    let ball = Collider::sphere(0.4);
    let at = |x: f32| (Vec3::X * x, Quat::IDENTITY, ball.clone());
    let hull = corners.0.clone();
    let shapes = [
        ("ball", Collider::sphere(0.5)),
        ("box", Collider::cuboid(1.0, 1.0, 1.0)),
        ("round box", Collider::round_cuboid(1.0, 1.0, 1.0, 0.1)),
        ("capsule", Collider::capsule_endpoints(0.4, Vec3::NEG_X, Vec3::X)),
        ("cylinder", Collider::cylinder(0.6, 1.0)),
        ("cone", Collider::cone(1.5, 1.0)),
        ("half space", Collider::half_space(Vec3::Y)),
        ("hull", Collider::convex_hull(hull).expect("a hull")),
        ("compound", Collider::compound(vec![at(-0.4), at(0.4)])),
        ("mesh", Collider::trimesh(corners.0, corners.1)),
        ("ground", Collider::heightfield(ground(9), Vec3::new(4.0, 1.0, 4.0))),
    ];
    for (name, collider) in shapes {
        let mut app = app();
        let shape = collider.clone();
        spawn_collider(&mut app, collider);
        let cloth = app.world_mut().spawn(sheet(HIGH)).id();
        run(&mut app, FALL);
        assert!(middle(&app, cloth).y > CARRIED, "{name}: {}", middle(&app, cloth));
        let is_ground = shape.shape().as_heightfield().is_some();
        for at in places(&app, cloth) {
            let distance = match is_ground {
                true => at.y,
                false => signed_distance(&shape, at),
            };
            assert!(distance > -DEPTH, "{name}: {distance} m at {at}");
        }
    }
}

/// Distance of a point from a shape at the origin, m; negative inside.
fn signed_distance(shape: &Collider, at: Vec3) -> f32 {
    let (nearest, is_inside) = shape.project_point(Vec3::ZERO, Quat::IDENTITY, at, false);
    let distance = nearest.distance(at);
    if is_inside { -distance } else { distance }
}

#[test]
fn cloth_drapes_over_a_body_that_moves_and_goes_along() {
    let mut app = app();
    let speed = 0.4;
    let table = (RigidBody::Kinematic, Collider::cuboid(1.0, 0.5, 1.0), Transform::default());
    let table = app.world_mut().spawn((table, LinearVelocity(Vec3::X * speed))).id();
    let cloth = app.world_mut().spawn(sheet(0.3)).id();
    run(&mut app, 5 * SECOND);
    let (cloth, table) = (middle(&app, cloth), position(&app, table));
    assert!(table.x > 4.5 * speed, "{table}");
    assert!((cloth.x - table.x).abs() < 0.2 && cloth.y > -1.0, "{cloth}, {table}");
}

#[test]
fn layers_of_avian_say_what_touches() {
    let falls = |of_collider: CollisionLayers, of_cloth: Option<CollisionLayers>| {
        let mut app = app();
        let ball = spawn_collider(&mut app, Collider::sphere(0.5));
        app.world_mut().entity_mut(ball).insert(of_collider);
        let cloth = app.world_mut().spawn(sheet(HIGH)).id();
        if let Some(layers) = of_cloth {
            app.world_mut().entity_mut(cloth).insert(layers);
        }
        run(&mut app, FALL);
        middle(&app, cloth).y < CARRIED
    };
    let [one, two] = [LayerMask(1), LayerMask(2)];
    assert!(!falls(CollisionLayers::DEFAULT, None));
    assert!(!falls(CollisionLayers::new(one, two), Some(CollisionLayers::new(two, one))));
    assert!(falls(CollisionLayers::new(one, two), Some(CollisionLayers::new(one, one))));
    assert!(falls(CollisionLayers::new(one, LayerMask::NONE), None));

    // They may change.
    let mut app = app();
    let ball = spawn_collider(&mut app, Collider::sphere(0.5));
    let cloth = app.world_mut().spawn(sheet(HIGH)).id();
    run(&mut app, FALL);
    assert!(middle(&app, cloth).y > CARRIED);
    app.world_mut().entity_mut(ball).insert(CollisionLayers::NONE);
    run(&mut app, FALL);
    assert!(middle(&app, cloth).y < CARRIED);
}

/// What ends that cloth touches a collider.
type End = fn(&mut App, Entity);

#[test]
fn a_collider_is_forgotten_when_it_is_removed_despawned_disabled_or_a_sensor() {
    let fates: [(&str, End); 4] = [
        ("removed", |app, it| _ = app.world_mut().entity_mut(it).remove::<Collider>()),
        ("despawned", |app, it| _ = app.world_mut().despawn(it)),
        ("disabled", |app, it| _ = app.world_mut().entity_mut(it).insert(ColliderDisabled)),
        ("a sensor", |app, it| _ = app.world_mut().entity_mut(it).insert(Sensor)),
    ];
    for (name, end) in fates {
        let mut app = app();
        let ball = spawn_collider(&mut app, Collider::sphere(0.5));
        let cloth = app.world_mut().spawn(sheet(HIGH)).id();
        run(&mut app, FALL);
        assert!(middle(&app, cloth).y > CARRIED, "{name}");
        end(&mut app, ball);
        run(&mut app, FALL);
        assert!(middle(&app, cloth).y < CARRIED, "{name}: {}", middle(&app, cloth));
        assert!(app.world().get::<ClothCollider>(ball).is_none(), "{name}");
    }
}

#[test]
fn a_sensor_that_collides_again_is_felt_again() {
    let mut app = app();
    let ball = spawn_collider(&mut app, Collider::sphere(0.5));
    app.world_mut().entity_mut(ball).insert(Sensor);
    run(&mut app, 3);
    assert!(cloth_collider(&app, ball).is_none());
    app.world_mut().entity_mut(ball).remove::<Sensor>();
    run(&mut app, 3);
    assert!(cloth_collider(&app, ball).is_some());
}

#[test]
fn scale_and_changes_of_shape_are_followed_and_margin_and_features_are_kept() {
    let mut app = app();
    let half = |app: &App, it| {
        cloth_collider(app, it).expect("a collider").shape.as_cuboid().expect("a box").half_extents
    };
    let body = spawn_collider(&mut app, Collider::cuboid(1.0, 2.0, 3.0));
    let scaled = Transform::from_scale(Vec3::new(2.0, 1.0, 0.5));
    app.world_mut().entity_mut(body).insert(scaled);
    // A part of the body with a scale of its own.
    let part = (Collider::cuboid(1.0, 1.0, 1.0), Transform::from_scale(Vec3::splat(3.0)));
    let part = app.world_mut().spawn((part, ChildOf(body))).id();
    run(&mut app, 3);
    assert_eq!(half(&app, body), Vec3::new(1.0, 1.0, 0.75));
    assert_eq!(half(&app, part), Vec3::new(3.0, 1.5, 0.75));
    let mut own = app.world_mut().get_mut::<ClothCollider>(body).expect("a collider");
    (own.margin, own.features) = (0.01, true);
    app.world_mut().get_mut::<Transform>(body).expect("a transform").scale = Vec3::ONE;
    run(&mut app, 2);
    assert_eq!(half(&app, body), Vec3::new(0.5, 1.0, 1.5));
    app.world_mut().entity_mut(body).insert(Collider::cuboid(0.2, 0.2, 0.2));
    run(&mut app, 2);
    assert_eq!(half(&app, body), Vec3::splat(0.1));
    let known = cloth_collider(&app, body).expect("a collider");
    assert!(known.margin == 0.01 && known.features);
}

#[test]
fn friction_is_that_of_the_collider_or_its_body_or_the_default() {
    let mut app = app();
    let body = spawn_collider(&mut app, Collider::sphere(0.5));
    let part = (Collider::sphere(0.2), Transform::from_xyz(1.0, 0.0, 0.0), ChildOf(body));
    let part = app.world_mut().spawn(part).id();
    run(&mut app, 3);
    assert_eq!([body, part].map(|it| friction(&app, it)), [0.5; 2]);
    app.world_mut().entity_mut(body).insert(Friction::new(0.9));
    run(&mut app, 2);
    assert_eq!([body, part].map(|it| friction(&app, it)), [0.9; 2]);
    app.world_mut().entity_mut(part).insert(Friction::new(0.1));
    run(&mut app, 2);
    assert_eq!([body, part].map(|it| friction(&app, it)), [0.9, 0.1]);
}

#[test]
fn a_collider_of_the_users_stays() {
    let mut app = app();
    let body = spawn_collider(&mut app, Collider::sphere(0.5));
    app.world_mut().entity_mut(body).insert(ClothCollider::ball(0.7));
    run(&mut app, 3);
    let shape = &cloth_collider(&app, body).expect("a collider").shape;
    assert_eq!(shape.as_ball().expect("a ball").radius, 0.7);
    assert_eq!(friction(&app, body), 1.0);
}
