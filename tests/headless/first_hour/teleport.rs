//! Item 6: no teleport is missed. Item 7: a teleport is detected by speed.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app_at, greatest_speed};

use super::strain;

/// Frames, from the first on, in one of which the pole is moved.
const FRAMES: usize = 8;

/// Spawns a pole and its flag, and moves the pole in one frame. Returns the greatest strain and speed (m/s).
fn jump(frame: usize, rate: f64, moved: Vec3) -> (f32, f32) {
    #[derive(Resource)]
    struct Frame(usize);
    let mut app = app_at(Duration::from_secs_f64(1.0 / rate));
    let pole = app.world_mut().spawn(Transform::default()).id();
    let flag = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
    app.insert_resource(Frame(0)).add_systems(
        Update,
        move |mut now: ResMut<Frame>, mut poles: Query<&mut Transform>| {
            if now.0 == frame {
                poles.get_mut(pole).expect("it stays").translation += moved;
            }
            now.0 += 1;
        },
    );
    let (mut worst, mut fastest) = (0.0_f32, 0.0_f32);
    for frame in 0..FRAMES + 8 {
        app.update();
        if frame > 2 {
            worst = worst.max(strain(&app, flag).greatest);
            fastest = fastest.max(greatest_speed(&app, flag));
        }
    }
    (worst, fastest)
}

#[test]
fn no_teleport_is_missed() {
    for rate in [40.0, 60.0, 64.0, 144.0] {
        for frame in 0..FRAMES {
            let (strain, speed) = jump(frame, rate, Vec3::new(25.0, 0.0, 0.0));
            assert!(strain < 0.05, "frame {frame} at {rate} Hz: strain {strain}");
            assert!(speed < 5.0, "frame {frame} at {rate} Hz: {speed} m/s");
        }
    }
}

#[test]
fn a_pole_that_snaps_by_less_than_two_metres_is_teleported() {
    for rate in [60.0, 64.0] {
        for frame in [4, 6] {
            let (strain, speed) = jump(frame, rate, Vec3::new(0.0, 0.0, 1.9));
            assert!(strain < 0.05, "frame {frame} at {rate} Hz: strain {strain}");
            assert!(speed < 5.0, "frame {frame} at {rate} Hz: {speed} m/s");
        }
    }
}
