//! Cloth sees the poses of bodies of this tick.

use avian3d::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;

use crate::app;

/// The body's position when cloth was simulated, m.
#[derive(Resource, Default)]
struct SeenByCloth(Vec3);

#[test]
fn cloth_sees_the_pose_that_physics_gave_a_body_in_the_same_tick() {
    let mut app = app();
    let note = |body: Single<&Transform, With<RigidBody>>, mut seen: ResMut<SeenByCloth>| {
        seen.0 = body.translation;
    };
    app.init_resource::<SeenByCloth>().add_systems(ClothTick, note.before(ClothSystems::Prepare));
    let moving = (RigidBody::Kinematic, LinearVelocity(Vec3::X * 20.0), Transform::default());
    let body = app.world_mut().spawn(moving).id();
    let mut before = Vec3::ZERO;
    for update in 0..10 {
        app.update();
        let now = app.world().get::<Transform>(body).expect("a transform").translation;
        assert_eq!(app.world().resource::<SeenByCloth>().0, now);
        assert!(update < 2 || now.x > before.x + 0.3, "the body stands still");
        before = now;
    }
}
