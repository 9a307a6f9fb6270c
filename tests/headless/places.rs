//! Tests of anchors without arithmetic: vertices brought to targets, chosen by places, and lost one by one.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, greatest, greatest_speed, run, state};

/// Greatest distance of a held vertex from its place, m: rounding.
const TOLERANCE: f32 = 2e-5;

const SHEET: ClothMesh = ClothMesh::grid(17, 9, 2.0, 1.0);

/// Place of a vertex in the world, m.
fn place(app: &App, cloth: Entity, vertex: u32) -> Vec3 {
    let frame = app.world().get::<GlobalTransform>(cloth).expect("a place");
    let at = state(app, cloth).vertex_position(vertex).expect("a vertex");
    frame.transform_point(at)
}

fn assert_at(app: &App, cloth: Entity, vertex: u32, at: Vec3) {
    let place = place(app, cloth, vertex);
    assert!(place.distance(at) < TOLERANCE, "vertex {vertex} is at {place}, not at {at}");
}

fn peg(app: &mut App, pose: Transform) -> Entity {
    app.world_mut().spawn(pose).id()
}

#[test]
fn vertices_are_brought_to_their_targets() {
    let mut app = app();
    let left = peg(&mut app, Transform::from_xyz(3.0, 2.0, 1.0));
    let right = peg(&mut app, Transform::from_xyz(5.0, 2.0, 1.0));
    let second = Anchor::at(right, ClothCorner::TopRight);
    let held = Attachment::at(left, ClothCorner::TopLeft).with_anchor(second);
    let cloth = app.world_mut().spawn((SHEET, held)).id();
    run(&mut app, 3);
    for tick in 0..40 {
        assert_at(&app, cloth, 0, Vec3::new(3.0, 2.0, 1.0));
        assert_at(&app, cloth, 16, Vec3::new(5.0, 2.0, 1.0));
        assert!(greatest_speed(&app, cloth) < 6.0, "it does not jump in tick {tick}");
        run(&mut app, 1);
    }
    // They follow, too.
    app.world_mut().entity_mut(right).insert(Transform::from_xyz(4.8, 2.1, 1.0));
    run(&mut app, 120);
    assert_at(&app, cloth, 16, Vec3::new(4.8, 2.1, 1.0));
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

#[test]
fn vertices_are_brought_to_turned_and_scaled_targets_at_an_offset() {
    let mut app = app();
    let pose = Transform::from_xyz(1.0, 2.0, 3.0)
        .with_rotation(Quat::from_rotation_y(1.2))
        .with_scale(Vec3::splat(2.0));
    let mast = peg(&mut app, pose);
    let turned = Transform::from_xyz(0.0, 0.5, 0.0)
        .with_rotation(Quat::from_rotation_z(0.4))
        .with_scale(Vec3::new(0.5, 0.5, 1.0));
    // The middle vertex of the mesh, which is half as large.
    let held = Attachment::at(mast, 4 * 17 + 8).with_offset(turned);
    let cloth = app.world_mut().spawn((SHEET, held)).id();
    run(&mut app, 20);
    assert_at(&app, cloth, 4 * 17 + 8, pose.transform_point(Vec3::new(0.0, 0.5, 0.0)));
    let fabric = state(&app, cloth).fabric().expect("a fabric");
    assert_eq!(fabric.rest_positions()[16].x, 1.0);
}

#[test]
fn an_anchor_that_is_added_brings_its_vertex_gently() {
    let mut app = app();
    let mast = peg(&mut app, Transform::IDENTITY);
    let cloth = app.world_mut().spawn((SHEET, Attachment::at(mast, ClothEdge::Left))).id();
    run(&mut app, 60);
    let post = peg(&mut app, Transform::from_xyz(1.8, 0.0, 0.3));
    let mut attachment = app.world_mut().get_mut::<Attachment>(cloth).expect("an attachment");
    attachment.anchors.push(Anchor::at(post, ClothCorner::TopRight));
    let mut fastest = 0.0_f32;
    for _ in 0..128 {
        run(&mut app, 1);
        fastest = fastest.max(greatest_speed(&app, cloth));
    }
    assert_at(&app, cloth, 16, Vec3::new(1.8, 0.0, 0.3));
    assert!(fastest < 12.0, "{fastest} m/s");
}

#[test]
fn the_mesh_may_come_after_the_attachment() {
    let mut app = app();
    let mast = peg(&mut app, Transform::from_xyz(0.0, 5.0, 0.0));
    let cloth = app.world_mut().spawn(Attachment::at(mast, ClothCorner::BottomRight)).id();
    run(&mut app, 3);
    app.world_mut().entity_mut(cloth).insert(SHEET);
    run(&mut app, 10);
    assert_at(&app, cloth, 9 * 17 - 1, Vec3::new(0.0, 5.0, 0.0));
    let attachment = app.world().get::<Attachment>(cloth).expect("an attachment");
    assert!(!attachment.brings_first);
}

#[test]
fn vertices_are_held_by_place_and_box() {
    let mut app = app();
    let by = [
        AttachedVertices::Nearest(vec![Vec3::ZERO, Vec3::new(2.1, 0.1, 0.0)]),
        AttachedVertices::InBox {
            low: Vec3::new(-0.1, -0.01, -1.0),
            high: Vec3::new(9.0, 1.0, 1.0),
        },
        AttachedVertices::Border { near: Vec3::ZERO },
    ];
    // Twice as large: places are those of the mesh.
    let large = Transform::from_scale(Vec3::splat(2.0));
    for (vertices, due) in by.into_iter().zip([2, 17, 2 * 17 + 2 * 7]) {
        let bundle = (SHEET, Attachment::in_place(vertices.clone()), large);
        let cloth = app.world_mut().spawn(bundle).id();
        run(&mut app, 5);
        let fabric = state(&app, cloth).fabric().expect("a fabric");
        let pinned = (0..fabric.particle_count()).filter(|&it| fabric.is_pinned(it)).count();
        assert_eq!(pinned, due, "{vertices:?}");
        assert!(fabric.is_pinned(0) && fabric.is_pinned(16), "{vertices:?}");
    }
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

#[test]
fn a_sheet_lies_flat_around_its_origin() {
    let mut app = app();
    app.insert_resource(ClothSettings { gravity: Vec3::ZERO, ..ClothSettings::default() });
    let sheet = ClothMesh::sheet(17, 9, 2.0, 1.0);
    let free = app.world_mut().spawn((sheet.clone(), LodSet::new([9.0]))).id();
    let large =
        app.world_mut().spawn((sheet, Transform::from_scale(Vec3::new(3.0, 1.0, 2.0)))).id();
    run(&mut app, 5);
    for (cloth, size) in [(free, Vec3::new(1.0, 0.0, 0.5)), (large, Vec3::new(3.0, 0.0, 1.0))] {
        let state = state(&app, cloth);
        let fabric = state.fabric().expect("a fabric");
        assert!(fabric.grid().is_some(), "it is simulated as a grid");
        let rest = fabric.rest_positions();
        assert_eq!(rest.len(), 17 * 9);
        assert!(
            rest[0].distance(-size) < 1e-5 && rest[17 * 9 - 1].distance(size) < 1e-5,
            "{}",
            rest[0]
        );
        assert!(state.normals().iter().all(|normal| normal.y > 0.99), "its front is up");
    }
    app.world_mut().entity_mut(free).insert(LodSet::new([9.0]).pinned_to(1));
    run(&mut app, 5);
    let state = state(&app, free);
    let rest = state.fabric().expect("a fabric").rest_positions();
    assert_eq!((rest.len(), state.level()), (9 * 5, 1));
    assert!(greatest(rest.iter().map(|at| at.y.abs())) < 1e-5);
    assert!(rest[0].distance(Vec3::new(-1.0, 0.0, -0.5)) < 1e-5, "{}", rest[0]);
}

#[test]
fn each_anchor_may_be_lost_in_its_own_way() {
    for (of_anchor, falls) in [(None, false), (Some(TargetLost::Release), true)] {
        let mut app = app();
        let left = peg(&mut app, Transform::IDENTITY);
        let right = peg(&mut app, Transform::from_xyz(2.0, 0.0, 0.0));
        let second = Anchor { on_lost: of_anchor, ..Anchor::at(right, ClothEdge::Right) };
        let held = Attachment::at(left, ClothEdge::Left).with_anchor(second);
        let cloth = app.world_mut().spawn((SHEET, held)).id();
        run(&mut app, 20);
        app.world_mut().despawn(right);
        run(&mut app, 64);
        assert_eq!(app.world().get::<ClothPaused>(cloth).is_none(), falls);
        assert_eq!(place(&app, cloth, 16).y < -0.3, falls);
        let lost = app.world().resource::<Seen<ClothTargetLost>>().0.clone();
        let outcome = if falls { TargetLost::Release } else { TargetLost::Freeze };
        assert_eq!(lost, [ClothTargetLost { entity: cloth, target: right, outcome }]);
        if falls {
            assert_at(&app, cloth, 0, Vec3::ZERO);
            // The attachment's own target still freezes it.
            app.world_mut().despawn(left);
            run(&mut app, 5);
            assert!(app.world().get::<ClothPaused>(cloth).is_some());
        }
        assert_finite(&app, cloth);
    }
    // The other way round: a torn flag of which one halyard is never to let go.
    let anchor = Anchor::new(Entity::PLACEHOLDER, 3).when_lost(TargetLost::Freeze);
    assert_eq!(anchor.on_lost, Some(TargetLost::Freeze));
}
