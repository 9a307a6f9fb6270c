//! Avian and cloth in an app with manual time: no window, no renderer, no GPU.

mod bad_input;
mod bodies;
mod colliders;
mod order;
mod rollback;

use avian3d::prelude::*;
use bevy_app::{App, TaskPoolPlugin};
use bevy_bunting::prelude::*;
use bevy_bunting_avian::{ClothAvianPlugin, ClothColliderFailed};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, state};

/// Updates in a second.
const SECOND: usize = 64;

/// An app with cloth and avian.
fn app() -> App {
    let mut app = bunting_tests::app();
    app.add_plugins((TaskPoolPlugin::default(), PhysicsPlugins::default()))
        .add_plugins(ClothAvianPlugin::default())
        .insert_resource(Seen::<ClothColliderFailed>(Vec::new()))
        .add_observer(|event: On<ClothColliderFailed>, mut seen: ResMut<Seen<_>>| {
            seen.0.push(*event.event());
        });
    app.finish();
    app
}

/// A horizontal sheet, 2 m wide, with its middle above the origin at a height (m); free.
fn sheet(height: f32) -> (ClothMesh, Transform) {
    let flat = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    let at = Transform::from_xyz(-1.0, height, -1.0).with_rotation(flat);
    (ClothMesh::grid(33, 33, 2.0, 2.0), at)
}

/// Positions of a cloth's particles in the world, m.
fn places(app: &App, cloth: Entity) -> Vec<Vec3> {
    let at = app.world().get::<Transform>(cloth).expect("a transform");
    state(app, cloth).positions().iter().map(|&position| at.transform_point(position)).collect()
}

/// Mean position of a cloth's particles in the world, m.
fn middle(app: &App, cloth: Entity) -> Vec3 {
    let places = places(app, cloth);
    places.iter().sum::<Vec3>() / places.len() as f32
}

/// Position of an entity, m.
fn position(app: &App, entity: Entity) -> Vec3 {
    app.world().get::<Transform>(entity).expect("a transform").translation
}
