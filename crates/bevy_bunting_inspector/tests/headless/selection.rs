//! Selection by a pointer.

use bevy_app::{App, PreUpdate};
use bevy_bunting::prelude::*;
use bevy_bunting_inspector::{ClothSelectionPlugin, SelectedCloth};
use bevy_camera::{Camera, NormalizedRenderTarget};
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Ray3d, Vec2, Vec3};
use bevy_picking::backend::ray::{RayId, RayMap};
use bevy_picking::pointer::{Location, PointerAction, PointerButton, PointerId, PointerInput};
use bevy_picking::{InteractionPlugin, PickingPlugin, PickingSystems};
use bevy_transform::prelude::*;
use bunting_tests::{run, spawn_flag};

/// The ray of the pointer, in the world.
#[derive(Resource)]
struct Ray(Ray3d);

/// Points along −z at a place, m, presses the button, and lets go.
fn click(app: &mut App, place: Vec3, button: PointerButton) {
    app.insert_resource(Ray(Ray3d::new(place + Vec3::Z, Dir3::NEG_Z)));
    let actions = [
        PointerAction::Move { delta: Vec2::ONE },
        PointerAction::Press(button),
        PointerAction::Release(button),
    ];
    for action in actions {
        let target = NormalizedRenderTarget::None { width: 100, height: 100 };
        let location = Location { target, position: Vec2::splat(50.0) };
        app.world_mut().write_message(PointerInput::new(PointerId::Mouse, location, action));
        run(app, 1);
    }
}

#[test]
fn a_click_selects_the_cloth_under_the_pointer() {
    let mut app = bunting_tests::app();
    app.add_plugins((PickingPlugin, InteractionPlugin, ClothDragPlugin, ClothSelectionPlugin))
        .insert_resource(Ray(Ray3d::new(Vec3::ZERO, Dir3::X)));
    let camera = (Camera::default(), Transform::from_xyz(0.0, 0.0, 3.0));
    let camera = app.world_mut().spawn(camera).id();
    app.world_mut().spawn(PointerId::Mouse);
    // A camera without a window has no rays of its own.
    let point = move |mut rays: ResMut<RayMap>, ray: Res<Ray>| {
        rays.map.insert(RayId::new(camera, PointerId::Mouse), ray.0);
    };
    let after_rays = point.after(PickingSystems::ProcessInput).before(PickingSystems::Backend);
    app.add_systems(PreUpdate, after_rays);
    let flags = [0.0, 3.0].map(|x| {
        let flag = spawn_flag(&mut app, Vec3::X * x);
        app.world_mut().entity_mut(flag).insert(ClothPaused);
        flag
    });
    app.finish();
    app.cleanup();
    run(&mut app, 5);
    let selected = |app: &App| app.world().resource::<SelectedCloth>().0;
    let on_first = Vec3::new(0.7, -0.5, 0.0);
    let on_second = on_first + Vec3::X * 3.0;

    assert_eq!(selected(&app), None);
    click(&mut app, on_second, PointerButton::Primary);
    assert_eq!(selected(&app), Some(flags[1]));
    click(&mut app, on_first, PointerButton::Secondary);
    assert_eq!(selected(&app), Some(flags[1]), "another button");
    click(&mut app, on_first, PointerButton::Primary);
    assert_eq!(selected(&app), Some(flags[0]));
    click(&mut app, Vec3::Y * 9.0, PointerButton::Primary);
    assert_eq!(selected(&app), Some(flags[0]), "a click beside");
    app.world_mut().despawn(flags[0]);
    assert_eq!(selected(&app), None, "it is gone");
}
