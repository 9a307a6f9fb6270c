//! Tests that the bones of a skeleton push the cloth that it wears.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Quat, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{app, greatest, run, state};

/// Vertices along each edge of the cape, 1 m wide.
const COUNT: u32 = 17;

/// Radius and half the length of a forearm, m.
const RADIUS: f32 = 0.06;
const HALF: f32 = 0.2;

/// Greatest depth of a particle in the forearm at the end of a tick, m.
const DEPTH: f32 = 0.005;

/// An elbow in front of the cape, which bends back and forth about the vertical.
#[derive(Component)]
struct Elbow;

fn bend(mut elbows: Query<&mut Transform, With<Elbow>>, time: Res<Time>) {
    for mut elbow in &mut elbows {
        elbow.rotation = Quat::from_rotation_y(1.2 * (3.0 * time.elapsed_secs()).sin());
    }
}

/// A cape on a chest with two elbows, of which one has a forearm that cloth may touch.
fn worn(forearm: Option<ClothCollider>) -> (App, Entity, Entity) {
    let mut app = app();
    app.add_systems(FixedUpdate, bend);
    let world = app.world_mut();
    let chest = world.spawn(Transform::from_xyz(0.0, 1.4, 0.0)).id();
    let elbow = (Elbow, Transform::from_xyz(0.5, -0.5, -0.1), ChildOf(chest));
    let elbow = world.spawn(elbow).id();
    let along = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    let pose = Transform::from_xyz(HALF, 0.0, 0.0).with_rotation(along);
    let arm = world.spawn((pose, ChildOf(elbow))).id();
    if let Some(forearm) = forearm {
        world.entity_mut(arm).insert(forearm);
    }
    let skin = ClothSkin::new([(chest, Mat4::IDENTITY)]);
    let all = (0..COUNT * COUNT).map(|_| ([0; 4], [1.0, 0.0, 0.0, 0.0]));
    let cape = (
        ClothMesh::grid(COUNT, COUNT, 1.0, 1.0),
        Attachment::new(chest, ClothEdge::Top),
        skin.with_vertices(all),
        LodSet { pinned: Some(0), ..LodSet::default() },
    );
    let cape = world.spawn(cape).id();
    (app, cape, arm)
}

/// Greatest depth of the cape in the forearm, and greatest distance of the cape behind the chest, m, over some swings.
fn swing(forearm: Option<ClothCollider>) -> [f32; 2] {
    let (mut app, cape, arm) = worn(forearm);
    run(&mut app, 30);
    let mut worst = [0.0_f32; 2];
    for _ in 0..240 {
        run(&mut app, 1);
        let pose = app.world().get::<GlobalTransform>(arm).expect("a forearm").affine().inverse();
        let frame = *app.world().get::<GlobalTransform>(cape).expect("a cape");
        let places = || state(&app, cape).positions().iter().map(|&at| frame.transform_point(at));
        let depth = |at: Vec3| {
            let at = pose.transform_point3(at);
            RADIUS - at.distance(Vec3::Y * at.y.clamp(-HALF, HALF))
        };
        worst[0] = worst[0].max(greatest(places().map(depth)));
        worst[1] = worst[1].max(greatest(places().map(|at| at.z)));
    }
    worst
}

#[test]
fn a_forearm_pushes_the_cape_as_its_elbow_bends() {
    let forearm = ClothCollider::capsule(HALF, RADIUS);
    let [depth, pushed] = swing(Some(forearm));
    let [through, hanging] = swing(None);
    assert!(depth < DEPTH, "{depth} m deep");
    assert!(pushed > 0.15, "pushed by {pushed} m");
    assert!(through > 5.0 * DEPTH && hanging < 0.05, "{through} m deep, {hanging} m without it");
}
