//! The broad phase: a cloth touches all colliders near it, however many others there are, and however they move.

use std::f32::consts::PI;

use bevy_app::{App, Update};
use bevy_bunting::{Attachment, ClothCollider, ClothEdge, ClothMesh};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;
use parry3d::shape::SharedShape;

use bunting_tests::{Bits, app, bits, run, state};

/// A sheet of half a metre that lies a metre above the origin.
fn spawn_sheet(app: &mut App) -> Entity {
    let flat =
        Transform::from_xyz(-0.25, 1.0, 0.25).with_rotation(Quat::from_rotation_x(-0.5 * PI));
    app.world_mut().spawn((ClothMesh::grid(9, 9, 0.5, 0.5), flat)).id()
}

/// Height of the lowest particle of a sheet in the world, m.
fn lowest(app: &App, sheet: Entity) -> f32 {
    let turn = Quat::from_rotation_x(-0.5 * PI);
    let heights = state(app, sheet).positions().iter().map(|&at| 1.0 + (turn * at).y);
    heights.fold(f32::MAX, f32::min)
}

#[test]
fn far_colliders_change_no_bit() {
    let simulate = |others: usize| -> Bits {
        let mut app = app();
        let sheet = spawn_sheet(&mut app);
        app.world_mut().spawn((ClothCollider::ball(0.3), Transform::from_xyz(0.05, 0.5, 0.0)));
        app.world_mut().spawn((ClothCollider::ground(), Transform::IDENTITY));
        for other in 0..others {
            let around = Quat::from_rotation_y(other as f32);
            let at =
                Transform::from_translation(around * Vec3::new(4.0 + 0.1 * other as f32, 0.5, 0.0));
            app.world_mut().spawn((ClothCollider::ball(0.3), at));
        }
        run(&mut app, 60);
        bits(&app, sheet)
    };
    assert_eq!(simulate(200), simulate(0));
}

#[test]
fn colliders_come_and_go() {
    let mut app = app();
    let sheet = spawn_sheet(&mut app);
    let floor = |y: f32| {
        (ClothCollider::cuboid(Vec3::new(1.0, 0.1, 1.0)), Transform::from_xyz(0.0, y - 0.1, 0.0))
    };
    let upper = app.world_mut().spawn(floor(0.7)).id();
    run(&mut app, 60);
    let height = lowest(&app, sheet);
    assert!((0.69..0.75).contains(&height), "on the upper floor: {height} m");
    app.world_mut().despawn(upper);
    let lower = app.world_mut().spawn(floor(0.2)).id();
    run(&mut app, 60);
    let height = lowest(&app, sheet);
    assert!((0.19..0.25).contains(&height), "on the lower floor: {height} m");
    app.world_mut().entity_mut(lower).remove::<ClothCollider>();
    run(&mut app, 120);
    assert!(lowest(&app, sheet) < -1.0, "there is no floor any more");
}

/// Something that is turned or moved in each frame.
#[derive(Component)]
struct Moving(fn(&mut Transform));

fn go_on(mut moving: Query<(&Moving, &mut Transform)>) {
    for (moving, mut transform) in &mut moving {
        moving.0(&mut transform);
    }
}

/// Greatest distance of any particle from its place at rest in some ticks, m, of a curtain at the origin that hangs
/// in the xy plane without wind, beside a moving collider.
fn displaced(collider: ClothCollider, at: Transform, moving: Moving) -> f32 {
    let mut app = app();
    app.add_systems(Update, go_on);
    let rail = app.world_mut().spawn(Transform::from_xyz(-0.5, 0.5, 0.0)).id();
    let curtain = (ClothMesh::grid(17, 17, 1.0, 1.0), Attachment::new(rail, ClothEdge::Top));
    let curtain = app.world_mut().spawn(curtain).id();
    run(&mut app, 60);
    let rest = state(&app, curtain).positions().to_vec();
    app.world_mut().spawn((collider, at, moving));
    let mut farthest = 0.0_f32;
    for _ in 0..60 {
        run(&mut app, 1);
        let ways = state(&app, curtain).positions().iter().zip(&rest);
        farthest = ways.map(|(at, rest)| at.distance(*rest)).fold(farthest, f32::max);
    }
    farthest
}

#[test]
fn a_fast_ball_is_met() {
    // It moves by a third of a metre in a tick, and is at the curtain in the middle of one.
    let ball = ClothCollider::ball(0.1);
    let fly = Moving(|transform| transform.translation.z -= 20.0 / 60.0);
    let way = displaced(ball, Transform::from_xyz(0.0, 0.0, 10.0 + 10.0 / 60.0), fly);
    assert!(way > 0.1, "{way} m");
}

#[test]
fn a_ball_that_is_faster_than_a_teleport_is_met() {
    // Its first change of place counts as a teleport. From then on it moves, and passes the curtain within a tick.
    let fly = Moving(|transform| transform.translation.z -= 40.0 / 60.0);
    let way = displaced(ClothCollider::ball(0.05), Transform::from_xyz(0.0, 0.0, 10.3), fly);
    assert!(way > 0.1, "{way} m");
}

#[test]
fn the_tip_of_a_turning_rod_is_met() {
    // The rod's end reaches the curtain in the middle of a tick only.
    let rod = ClothCollider::new(SharedShape::capsule_x(1.0, 0.01));
    let turn = Moving(|transform| transform.rotate_y(PI / 9.0));
    let at = Transform::from_xyz(0.0, 0.0, 1.0);
    let way = displaced(rod, at, turn);
    assert!(way > 0.005, "{way} m");
}

#[test]
fn a_collider_far_from_the_origin_is_met() {
    let mut app = app();
    let far = Vec3::new(3000.0, 0.0, -2000.0);
    let flat =
        Transform::from_translation(far + Vec3::Y).with_rotation(Quat::from_rotation_x(-0.5 * PI));
    let sheet = app.world_mut().spawn((ClothMesh::grid(9, 9, 0.5, 0.5), flat)).id();
    let floor = ClothCollider::cuboid(Vec3::new(2.0, 0.5, 2.0));
    app.world_mut().spawn((floor, Transform::from_translation(far)));
    run(&mut app, 90);
    let height = lowest(&app, sheet);
    assert!((0.48..0.55).contains(&height), "{height} m");
}
