//! Tests of wind and colliders.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{GustTravel, TickWind};
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Quat, Vec2, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, app_at, assert_finite, greatest, run, state};

/// Greatest depth of a particle in a collider at the end of a tick, m.
const DEPTH: f32 = 5e-3;

#[test]
fn winds_add_up() {
    let mut app = app();
    let gusty = WindField::steady(Vec3::X).with_gusts(1.0, 0.5, 3);
    app.world_mut().spawn(WindField::steady(Vec3::new(3.0, 0.0, 1.0)));
    let field = app.world_mut().spawn(gusty).id();
    run(&mut app, 20);
    let travel = app.world().get::<GustTravel>(field).unwrap().0;
    assert_ne!(travel, DVec3::ZERO);
    let place = Vec3::new(1.0, 2.0, 3.0);
    let sum = Vec3::new(3.0, 0.0, 1.0) + gusty.velocity_at(place, travel);
    assert_eq!(app.world().resource::<TickWind>().at(place), sum);
}

#[test]
fn wind_is_in_world_space() {
    for turn in [0.0, 1.0, 3.0] {
        let mut app = app();
        let turned = Transform::from_rotation(Quat::from_rotation_y(turn));
        let held = Attachment::in_place(ClothEdge::Left);
        let cloth = app.world_mut().spawn((FLAG, held, turned)).id();
        run(&mut app, 60);
        let tip = state(&app, cloth).positions()[16];
        assert!(tip.z.abs() < 0.2, "{tip} without wind");
        let along_its_normal = turned.rotation * Vec3::new(0.0, 0.0, -8.0);
        app.world_mut().spawn(WindField::steady(along_its_normal));
        run(&mut app, 100);
        let tip = state(&app, cloth).positions()[16];
        assert!(tip.z < -0.5, "{tip}");
    }
}

#[test]
fn gusts_do_not_depend_on_the_frame_rate() {
    let winds = |rate: f64| {
        #[derive(Resource, Default)]
        struct Winds(Vec<Vec3>);
        let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
        app.init_resource::<Winds>()
            .add_systems(FixedLast, |wind: Res<TickWind>, mut winds: ResMut<Winds>| {
                winds.0.push(wind.at(Vec3::X))
            });
        app.world_mut().spawn(WindField::default().with_gusts(4.0, 2.0, 9));
        run(&mut app, rate as usize);
        core::mem::take(&mut app.world_mut().resource_mut::<Winds>().0)
    };
    let (slow, fast) = (winds(20.0), winds(200.0));
    let both = slow.len().min(fast.len());
    assert!(both > 50);
    assert_eq!(slow[..both], fast[..both]);
    assert!(slow.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn cloth_lies_on_colliders() {
    // A fall onto a ball on the ground is simulated in several frames, turned about the vertical.
    let flat = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    for turn in [0.0, 1.0, 2.0] {
        let rotation = Quat::from_rotation_y(turn) * flat;
        let middle = rotation * Vec3::new(0.5, -0.5, 0.0);
        let above = Transform::from_rotation(rotation).with_translation(Vec3::Y - middle);
        let mut app = app();
        let cloth = app.world_mut().spawn((ClothMesh::grid(17, 17, 1.0, 1.0), above)).id();
        app.world_mut().spawn((ClothCollider::ground(), Transform::from_xyz(0.0, -0.4, 0.0)));
        app.world_mut().spawn((ClothCollider::ball(0.4), Transform::default()));
        let mut nearest = f32::MAX;
        for _ in 0..300 {
            app.update();
            let global = *app.world().get::<GlobalTransform>(cloth).expect("placed");
            for &position in state(&app, cloth).positions() {
                let world = global.transform_point(position);
                assert!(world.y > -0.4 - DEPTH, "{world} is under ground");
                let gap = world.length() - 0.4;
                assert!(gap > -DEPTH, "{gap} m from the ball");
                nearest = nearest.min(gap);
            }
        }
        assert_finite(&app, cloth);
        assert!(nearest < DEPTH, "it never touched the ball, by {nearest} m");
    }
}

#[test]
fn a_moving_collider_pushes() {
    #[derive(Component)]
    struct Fist;
    let mut app = app();
    app.world_mut().spawn((Fist, ClothCollider::ball(0.2), Transform::from_xyz(0.3, -0.5, -1.0)));
    app.add_systems(
        FixedUpdate,
        |mut fists: Query<&mut Transform, With<Fist>>, time: Res<Time>| {
            for mut transform in &mut fists {
                transform.translation.z = (time.elapsed_secs() - 2.0).min(0.6);
            }
        },
    );
    let top = Attachment::in_place(ClothEdge::Top);
    let curtain = app.world_mut().spawn((ClothMesh::grid(17, 17, 1.0, 1.0), top)).id();
    run(&mut app, 180);
    let pushed = greatest(state(&app, curtain).positions().iter().map(|position| position.z));
    assert!(pushed > 0.5, "{pushed} m");
    assert_finite(&app, curtain);
}

#[test]
fn a_collider_that_moves_with_the_cloth_acts_like_one_at_rest() {
    let pushed = |speed: f32| {
        let mut app = app();
        app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
        let curtain = ClothMesh::grid(17, 17, 1.0, 1.0);
        let held = Attachment::in_place(ClothEdge::Top);
        let damped = ClothMaterial(FabricMaterial { damping: 3.0, ..FabricMaterial::DENIM });
        let curtain = app.world_mut().spawn((curtain, damped, held)).id();
        let ball = Transform::from_xyz(0.5, -0.7, -0.31);
        let ball = app.world_mut().spawn((ClothCollider::ball(0.3), ball)).id();
        app.add_systems(
            FixedUpdate,
            move |mut transforms: Query<&mut Transform>, time: Res<Time>| {
                for entity in [curtain, ball] {
                    let mut transform = transforms.get_mut(entity).expect("a transform");
                    transform.translation.x += speed * time.delta_secs();
                    if entity == ball {
                        transform.translation.z = (-0.31 + 0.2 * time.elapsed_secs()).min(-0.1);
                    }
                }
            },
        );
        run(&mut app, 300);
        // Wrinkles beside the ball may fold to either side, so only the bulge in front of it is compared.
        let centre = Vec2::new(0.5, -0.7);
        let in_front = |position: &&Vec3| position.truncate().distance(centre) < 0.15;
        let bulge = state(&app, curtain).positions().iter().filter(in_front);
        greatest(bulge.map(|position| position.z))
    };
    let (resting, moving) = (pushed(0.0), pushed(20.0));
    assert!(resting > 0.1, "{resting}");
    assert!((resting - moving).abs() < 4.0 * DEPTH, "{resting} {moving}");
}
