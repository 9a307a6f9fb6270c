//! Tests that cloth follows a skeleton that replaces another one.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, greatest, run, state, stretches};

/// Particles along an edge of the cape, which is a metre wide and high.
const COUNT: usize = 9;

/// Error of a place by rounding, m.
const TOLERANCE: f32 = 1e-5;

/// Spawns a skeleton of hips and two shoulders.
fn skeleton(app: &mut App, at: Vec3) -> [Entity; 3] {
    let world = app.world_mut();
    let hips = world.spawn(Transform::from_translation(at)).id();
    let shoulders = [Vec3::ZERO, Vec3::X]
        .map(|at| world.spawn((Transform::from_translation(at), ChildOf(hips))).id());
    [hips, shoulders[0], shoulders[1]]
}

fn skin([_, left, right]: [Entity; 3]) -> ClothSkin {
    let vertices = (0..COUNT * COUNT).map(|vertex| {
        let part = (vertex % COUNT) as f32 / (COUNT - 1) as f32;
        ([0, 1, 0, 0], [1.0 - part, part, 0.0, 0.0])
    });
    ClothSkin::new([(left, Mat4::IDENTITY), (right, Mat4::from_translation(-Vec3::X))])
        .with_vertices(vertices)
}

/// A cape on a skeleton, after two seconds.
fn caped(app: &mut App) -> ([Entity; 3], Entity) {
    let skeleton = skeleton(app, Vec3::Y);
    let cape = ClothMesh::grid(COUNT as u32, COUNT as u32, 1.0, 1.0);
    let held = Attachment::new(skeleton[0], ClothEdge::Top);
    let finest = LodSet { pinned: Some(0), ..LodSet::default() };
    let cape = app.world_mut().spawn((cape, held, finest, skin(skeleton))).id();
    run(app, 128);
    (skeleton, cape)
}

/// Greatest distance of a pin from its place on a skeleton, m.
fn apart(app: &App, cape: Entity, hips: Entity) -> f32 {
    let global = |entity: Entity| app.world().get::<GlobalTransform>(entity).expect("a transform");
    let positions = state(app, cape).positions();
    greatest((0..COUNT).map(|pin| {
        let place = Vec3::X * (pin as f32 / (COUNT - 1) as f32);
        global(cape).transform_point(positions[pin]).distance(global(hips).transform_point(place))
    }))
}

#[test]
fn sleeping_cloth_follows_the_joints_that_replace_others() {
    // The cloth's frame stays on the old skeleton.
    for way in [0.05, 0.3, 3.0] {
        for despawns in [false, true] {
            let mut app = app();
            let (old, cape) = caped(&mut app);
            assert_eq!(state(&app, cape).activity(), ClothActivity::AtRest);
            let new = skeleton(&mut app, Vec3::new(way, 1.0, 0.0));
            app.world_mut().entity_mut(cape).insert(skin(new));
            if despawns {
                old[1..].iter().for_each(|&joint| app.world_mut().entity_mut(joint).despawn());
            }
            for _ in 0..128 {
                run(&mut app, 1);
                let most = greatest(stretches(&app, cape));
                assert!(most < 1.05, "{most} on the way of {way} m");
            }
            let apart = apart(&app, cape, new[0]);
            assert!(apart < TOLERANCE, "{apart} m off after {way} m, despawned: {despawns}");
            assert_eq!(app.world().resource::<Seen<ClothFailed>>().0.len(), 0);
        }
    }
}

#[test]
fn cloth_follows_a_skeleton_that_replaces_its_target_too() {
    let mut app = app();
    let (old, cape) = caped(&mut app);
    let new = skeleton(&mut app, Vec3::new(3.0, 1.0, 0.0));
    let mut of_cape = app.world_mut().entity_mut(cape);
    of_cape.get_mut::<Attachment>().expect("attached").target = new[0];
    of_cape.insert(skin(new));
    app.world_mut().entity_mut(old[0]).despawn();
    run(&mut app, 2);
    let apart = apart(&app, cape, new[0]);
    assert!(apart < TOLERANCE, "{apart} m off");
}

#[test]
fn a_joint_that_does_not_exist_is_reported_once() {
    let mut app = app();
    let (_, cape) = caped(&mut app);
    let mut new = skeleton(&mut app, Vec3::Y);
    app.world_mut().entity_mut(new[2]).despawn();
    let hips = new[0];
    new[0] = Entity::PLACEHOLDER;
    app.world_mut().entity_mut(cape).insert(skin(new));
    run(&mut app, 64);
    let failed = &app.world().resource::<Seen<ClothFailed>>().0;
    let [ClothFailed { error: ClothError::MissingJoint { entity, joint }, .. }] = failed[..] else {
        panic!("{failed:?}")
    };
    assert_eq!((entity, joint), (cape, new[2]));
    assert_finite(&app, cape);
    assert!(apart(&app, cape, hips) < 1.0);
}

#[test]
fn other_limits_wake_sleeping_cloth() {
    let mut app = app();
    let (_, cape) = caped(&mut app);
    let limits = SkinLimits { max_distance: 0.01.into(), ..SkinLimits::default() };
    app.world_mut().entity_mut(cape).insert(limits);
    run(&mut app, 2);
    assert_eq!(state(&app, cape).activity(), ClothActivity::Ticking);
}
