//! Tests that a track has a constant speed, faces forward, and is closed.

use bevy_math::Vec3;
use bunting_scenes::{Route, Track};

/// Relative error of the speed, from bends between the samples of a track.
const SPEED_TOLERANCE: f32 = 0.01;

fn oval() -> Route {
    let waypoints =
        [(-60.0, 8.0), (60.0, 8.0), (95.0, -25.0), (60.0, -58.0), (-60.0, -58.0), (-95.0, -25.0)];
    Route {
        waypoints: waypoints.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(),
        speed: 20.0,
        start: 7.0,
    }
}

#[test]
fn the_speed_is_constant_and_forward() {
    let track = Track::new(&oval());
    let tick = 1.0 / 64.0;
    for step in 0..2000 {
        let time = f64::from(step) * tick;
        let (from, to) = (track.pose(time), track.pose(time + tick));
        let velocity = (to.translation - from.translation) / tick as f32;
        assert!((velocity.length() / 20.0 - 1.0).abs() < SPEED_TOLERANCE, "{velocity} at {time} s");
        assert!(velocity.normalize().dot(*from.forward()) > 0.999, "{velocity} at {time} s");
    }
}

#[test]
fn the_path_is_closed() {
    let track = Track::new(&oval());
    let round = track.length() / 20.0;
    let (start, back) = (track.pose(0.0), track.pose(round));
    assert!(start.translation.distance(back.translation) < 1e-3);
    assert!(track.pose_at(0.0).translation.distance(Vec3::new(-60.0, 0.0, 8.0)) < 1e-4);
}
