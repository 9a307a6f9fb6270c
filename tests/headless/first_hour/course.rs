//! Item 11: colliders that move in `Update` act at their displayed positions.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{app_at, state};

/// Speed of the ball, m/s: a curtain can be pushed aside by it without being strained too far.
const SPEED: f32 = 5.0;

const RADIUS: f32 = 0.3;

/// Greatest distance by which a ball stands out of the cloth that it pushes, m. The cloth is a curtain of 4 m
/// × 4 m in the plane z = 0; the ball comes from behind.
fn lateness(rate: f64) -> f32 {
    let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
    app.world_mut().resource_mut::<ClothSettings>().gravity = Vec3::ZERO;
    let held = Attachment::in_place(ClothEdge::Top);
    let curtain = app.world_mut().spawn((ClothMesh::grid(33, 33, 4.0, 4.0), held)).id();
    let ball = Transform::from_xyz(2.0, -2.0, -2.0);
    let ball = app.world_mut().spawn((ClothCollider::ball(RADIUS), ball)).id();
    app.add_systems(Update, move |mut balls: Query<&mut Transform>, time: Res<Time>| {
        balls.get_mut(ball).expect("it stays").translation.z += SPEED * time.delta_secs();
    });
    let mut worst: Option<f32> = None;
    for _ in 0..rate as usize {
        app.update();
        let front = app.world().get::<Transform>(ball).expect("it stays").translation.z + RADIUS;
        let pushed = state(&app, curtain).positions().get(16 * 33 + 16).map_or(0.0, |at| at.z);
        if pushed > 0.2 && front < 0.5 {
            worst = Some(worst.unwrap_or(f32::MIN).max(front - pushed));
        }
    }
    worst.expect("the curtain never moved")
}

#[test]
fn colliders_act_where_they_are_seen() {
    for rate in [30.0, 47.0, 60.0, 144.0] {
        let late = lateness(rate);
        // Up to one tick may pass between the last tick and the frame.
        assert!(late < SPEED / 64.0 + 0.02, "{late} m late at {rate} Hz");
    }
}
