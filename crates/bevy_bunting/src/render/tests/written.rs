//! Tests of the contents of written meshes, and of the frames in which meshes are written.

use bevy_gizmos::config::GizmoConfigStore;
use bevy_gizmos::{GizmoHandles, GizmoPlugin};

use super::*;
use crate::render::debug::{ClothDebugPlugin, ClothGizmos};

#[test]
fn a_mesh_is_the_surface_between_two_ticks() {
    let mut app = app(TICK.mul_f64(0.3));
    let cloth = spawn(&mut app, ());
    run(&mut app, 49);
    let state = app.world().get::<ClothState>(cloth).expect("a cloth");
    let (before, after) = (state.previous_positions()[8], state.positions()[8]);
    let shown = Vec3::from(positions(&app, cloth)[8]);
    let part = (shown - before).dot(after - before) / (after - before).length_squared();
    assert!(part > 0.05 && part < 0.95, "{part}");
    assert!(is_current(&app, cloth));
    let normals = values(mesh(&app, cloth), Mesh::ATTRIBUTE_NORMAL);
    assert_eq!(*normals, arrays(&surface(&app, cloth).normals));
    assert_eq!(mesh(&app, cloth).indices().map(bevy_mesh::Indices::len), Some(8 * 4 * 6));
    assert!(mesh(&app, cloth).contains_attribute(Mesh::ATTRIBUTE_UV_0));
}

#[test]
fn writing_allocates_nothing() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 3);
    let (pointer, old) = (positions(&app, cloth).as_ptr(), positions(&app, cloth).clone());
    run(&mut app, 10);
    assert_eq!(positions(&app, cloth).as_ptr(), pointer);
    assert_ne!(*positions(&app, cloth), old);
}

#[test]
fn a_cloth_at_rest_is_not_written() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 5);
    modified(&mut app);
    run(&mut app, 1);
    assert_eq!(modified(&mut app), 1);
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    run(&mut app, 3);
    modified(&mut app);
    run(&mut app, 3);
    assert_eq!(modified(&mut app), 0);
}

#[test]
fn bounds_hold_and_a_cloth_is_written_when_it_comes_back_into_view() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 10);
    let seen = |app: &App| app.world().get::<ViewVisibility>(cloth).expect("a mesh").get();
    assert!(seen(&app));

    app.world_mut().entity_mut(cloth).insert(Transform::from_xyz(0.0, 0.0, 50.0));
    run(&mut app, 2);
    assert!(!seen(&app));
    let old = positions(&app, cloth).clone();
    modified(&mut app);
    run(&mut app, 20);
    assert_eq!(*positions(&app, cloth), old);
    assert_eq!(modified(&mut app), 0);
    let bounds = app.world().get::<Aabb>(cloth).expect("a mesh has bounds");
    for &position in &surface(&app, cloth).positions {
        let off = (Vec3A::from(position) - bounds.center).abs() - bounds.half_extents;
        assert!(off.max_element() < ROUNDING, "{position} is out of {bounds:?}");
    }

    app.world_mut().entity_mut(cloth).insert(Transform::default());
    run(&mut app, 1);
    assert!(seen(&app));
    assert!(is_current(&app, cloth));
    assert_eq!(modified(&mut app), 1);
}

#[test]
fn without_meshes_nothing_is_drawn() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(TICK));
    let cloth = spawn(&mut app, ());
    run(&mut app, 5);
    assert!(app.world().get::<ClothSurface>(cloth).is_none());
    assert!(app.world().get::<ClothState>(cloth).is_some_and(|state| state.fabric().is_some()));
}

#[test]
fn a_camera_gets_a_viewer() {
    let mut app = app(TICK);
    run(&mut app, 1);
    assert!(
        app.world_mut()
            .query_filtered::<(), (With<Camera3d>, With<LodViewer>)>()
            .single(app.world())
            .is_ok()
    );
}

#[test]
fn gizmos_of_chosen_cloths_are_drawn() {
    let mut app = app(TICK);
    app.add_plugins((GizmoPlugin, ClothDebugPlugin));
    let [cloth, _] = [0.0_f32, 0.5].map(|x| spawn(&mut app, Transform::from_xyz(x, 0.0, 0.0)));
    let drawn = |app: &mut App| {
        run(app, 3);
        let handles = app.world().resource::<GizmoHandles>().handles();
        handles.get(&core::any::TypeId::of::<ClothGizmos>()).is_some_and(Option::is_some)
    };
    assert!(!drawn(&mut app));
    app.world_mut().entity_mut(cloth).insert(ClothGizmos::ALL);
    assert!(drawn(&mut app));
    app.world_mut().entity_mut(cloth).remove::<ClothGizmos>();
    assert!(!drawn(&mut app));
    *app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<ClothGizmos>().1 =
        ClothGizmos::ALL;
    assert!(drawn(&mut app));
}
