//! Item 8: the scale of targets and parents scales the offset only.

use bevy_bunting::prelude::*;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, run, state};

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
fn a_cloth_that_is_scaled_itself_keeps_its_shape() {
    let mut app = app();
    let held = Attachment::in_place(ClothEdge::Left);
    let place = Transform::from_xyz(1.0, 2.0, 3.0).with_scale(SCALE);
    let cloth = app.world_mut().spawn((FLAG, held, place)).id();
    run(&mut app, 5);
    let (off, shear) = errors(&app, cloth, cloth, Transform::IDENTITY);
    assert!(off < 1e-5 && shear < 1e-5, "{off} m off, sheared by {shear}");
}
