//! Item 8: the scale of targets scales the offset only; that of the cloth itself and of all above it is baked.

use bevy_bunting::prelude::*;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, run, state};

const SCALE: Vec3 = Vec3::new(2.0, 1.0, 0.5);

/// Greatest distance of held vertices from their places on the target, m, and greatest error of the cloth's
/// axes compared with orthogonal unit vectors.
fn errors(app: &bevy_app::App, target: Entity, cloth: Entity, offset: Transform) -> (f32, f32) {
    let global = |entity: Entity| *app.world().get::<GlobalTransform>(entity).expect("placed");
    let (target, drawn) = (global(target), global(cloth));
    let origin = target.transform_point(offset.translation);
    let rotation = target.rotation() * offset.rotation;
    let state = state(app, cloth);
    let fabric = state.fabric().expect("a fabric");
    let held = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
    let off = held.map(|particle| {
        let place = origin + rotation * fabric.rest_positions()[particle];
        drawn.transform_point(state.positions()[particle]).distance(place)
    });
    let axes = drawn.affine().matrix3;
    let product = axes.transpose() * axes;
    let shear = [(product.x_axis, Vec3::X), (product.y_axis, Vec3::Y), (product.z_axis, Vec3::Z)]
        .map(|(axis, unit)| Vec3::from(axis).distance(unit));
    (off.fold(0.0, f32::max), shear.into_iter().fold(0.0, f32::max))
}

fn offset() -> Transform {
    Transform::from_xyz(0.4, 0.3, -0.2).with_rotation(Quat::from_rotation_z(0.9))
}

#[test]
fn a_child_of_a_scaled_target_keeps_its_shape() {
    let mut app = app();
    let turned = Quat::from_rotation_y(0.4);
    let target = app.world_mut().spawn(Transform::from_scale(SCALE).with_rotation(turned)).id();
    let held = Attachment::new(target, ClothEdge::Left).with_offset(offset());
    let cloth = app.world_mut().spawn((FLAG, held, ChildOf(target))).id();
    for _ in 0..5 {
        run(&mut app, 2);
        app.world_mut().get_mut::<Transform>(target).expect("it stays").translation.y += 0.01;
        run(&mut app, 1);
        let (off, shear) = errors(&app, target, cloth, offset());
        assert!(off < 1e-5 && shear < 1e-5, "{off} m off, sheared by {shear}");
    }
}

#[test]
fn a_child_of_another_scaled_parent_keeps_its_shape() {
    let mut app = app();
    let turned = Quat::from_rotation_y(0.4);
    let target = app.world_mut().spawn(Transform::from_xyz(1.0, 2.0, 3.0)).id();
    let parent = app.world_mut().spawn(Transform::from_scale(SCALE).with_rotation(turned)).id();
    let held = Attachment::new(target, ClothEdge::Left).with_offset(offset());
    let cloth = app.world_mut().spawn((FLAG, held, ChildOf(parent))).id();
    let tip = app.world_mut().spawn((Transform::from_xyz(1.0, 0.0, 0.0), ChildOf(cloth))).id();
    for _ in 0..5 {
        run(&mut app, 2);
        app.world_mut().get_mut::<Transform>(target).expect("it stays").translation.y += 0.01;
        run(&mut app, 1);
        let (off, shear) = errors(&app, target, cloth, offset());
        assert!(off < 1e-5 && shear < 1e-5, "{off} m off, sheared by {shear}");
        let global = |entity: Entity| *app.world().get::<GlobalTransform>(entity).expect("placed");
        let off = global(tip).translation().distance(global(cloth).transform_point(Vec3::X));
        assert!(off < 1e-5, "a child of the cloth is {off} m off");
    }
}

#[test]
fn the_scale_of_a_cloth_itself_is_baked() {
    let mut app = app();
    let held = Attachment::in_place(ClothEdge::Left);
    let place = Transform::from_xyz(1.0, 2.0, 3.0).with_scale(SCALE);
    let cloth = app.world_mut().spawn((FLAG, held, place)).id();
    run(&mut app, 5);
    let (off, shear) = errors(&app, cloth, cloth, Transform::IDENTITY);
    assert!(off < 1e-5 && shear < 1e-5, "{off} m off, sheared by {shear}");
    let size = size(&app, cloth);
    assert!(size.abs_diff_eq(Vec3::new(2.0 * 1.5, 1.0, 0.0), 1e-4), "{size}");
}

/// Extent of a cloth's fabric, m.
fn size(app: &bevy_app::App, cloth: Entity) -> Vec3 {
    let rest = state(app, cloth).fabric().expect("a fabric").rest_positions();
    let ends = [Vec3::min, Vec3::max].map(|end| rest.iter().copied().reduce(end).expect("some"));
    ends[1] - ends[0]
}

#[test]
fn scales_of_a_turned_hierarchy_shear_the_cloth() {
    let mut app = app();
    let parent = Transform::from_xyz(0.0, 3.0, 0.0).with_scale(SCALE);
    let parent = app.world_mut().spawn(parent).id();
    let local = Transform::from_rotation(Quat::from_rotation_z(0.5));
    let held = Attachment::in_place(ClothEdge::Left);
    let cloth = app.world_mut().spawn((FLAG, held, local, ChildOf(parent))).id();
    run(&mut app, 5);
    let frame = *app.world().get::<GlobalTransform>(cloth).expect("placed");
    let state = state(&app, cloth);
    let rest = state.fabric().expect("a fabric").rest_positions();
    for row in 0..9 {
        let vertex = row * 17;
        let mesh = Vec3::new(0.0, -(row as f32) / 8.0, 0.0);
        let place = Vec3::new(0.0, 3.0, 0.0) + SCALE * (local.rotation * mesh);
        let particle = state.particle_of_vertex(vertex).expect("a particle");
        let at = state.vertex_position(vertex).expect("a vertex");
        let drawn = frame.transform_point(at);
        assert!(drawn.distance(place) < 1e-3, "{drawn} for {place}");
        assert!(state.fabric().expect("a fabric").is_pinned(particle));
    }
    let tip = state.particle_of_vertex(16).expect("a particle");
    let far = frame.transform_point(rest[tip]);
    let place = Vec3::new(0.0, 3.0, 0.0) + SCALE * (local.rotation * (1.5 * Vec3::X));
    assert!(far.distance(place) < 1e-3, "{far} for {place}");
}

#[test]
fn a_mirrored_cloth_keeps_its_front() {
    let mut app = app();
    let held = Attachment::in_place(ClothEdge::Left);
    let mirrored = Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let cloth = app.world_mut().spawn((FLAG, held, mirrored)).id();
    run(&mut app, 3);
    let frame = *app.world().get::<GlobalTransform>(cloth).expect("placed");
    let state = state(&app, cloth);
    let particle = state.particle_of_vertex(16).expect("a particle");
    let rest = state.fabric().expect("a fabric").rest_positions();
    let tip = frame.transform_point(rest[particle]);
    assert!(tip.abs_diff_eq(-1.5 * Vec3::X, 1e-4), "{tip}");
    let normal = frame.rotation() * state.normals()[particle];
    assert!(normal.z > 0.5, "{normal}");
}

#[test]
fn the_scale_of_an_offset_is_baked() {
    let mut app = app();
    let target = app.world_mut().spawn(Transform::from_scale(SCALE)).id();
    let held = Attachment::new(target, ClothEdge::Left)
        .with_offset(Transform::from_scale(0.5 * Vec3::ONE));
    let cloth = app.world_mut().spawn((FLAG, held)).id();
    run(&mut app, 3);
    let size = size(&app, cloth);
    assert!(size.abs_diff_eq(Vec3::new(0.75, 0.5, 0.0), 1e-4), "{size}");
}

#[test]
fn a_scale_of_zero_is_reported() {
    let mut app = app();
    let flat = Transform::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let held = Attachment::in_place(ClothEdge::Left);
    let cloth = app.world_mut().spawn((FLAG, held, flat)).id();
    let other = app.world_mut().spawn((FLAG, Attachment::in_place(ClothEdge::Left))).id();
    run(&mut app, 5);
    let seen = &app.world().resource::<Seen<ClothFailed>>().0;
    let is_seen = seen
        .iter()
        .any(|event| matches!(event.error, ClothError::Scale { entity } if entity == cloth));
    assert!(is_seen, "{seen:?}");
    assert!(state(&app, cloth).positions().is_empty());
    assert!(!state(&app, other).positions().is_empty());
}
