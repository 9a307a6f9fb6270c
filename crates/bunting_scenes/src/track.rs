//! Driving along a closed way at a constant speed.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_math::cubic_splines::{CubicCardinalSpline, CubicCurve, CyclicCubicGenerator};
use bevy_math::curve::{Curve, UnevenSampleAutoCurve};
use bevy_time::Time;
use bevy_transform::components::Transform;

use crate::scene::Route;

/// Pieces of a curve between two waypoints whose lengths are taken as those of their chords. Fewer:
/// the speed wavers in bends.
const PIECES: usize = 256;

/// Moves an entity along a closed way, −z ahead, as a function of time only.
#[derive(Component, Clone, Debug)]
pub struct Track {
    curve: CubicCurve<Vec3>,
    /// Parameter of the curve at a length along it in m.
    parameter: UnevenSampleAutoCurve<f32>,
    length: f64,
    speed: f64,
    start: f64,
}

impl Track {
    /// The way that a route describes: a closed Catmull–Rom curve through its waypoints.
    ///
    /// # Panics
    ///
    /// If there are fewer than two waypoints, or some that are not finite; [`load`](crate::load)
    /// reads no such scene.
    #[must_use]
    pub fn new(route: &Route) -> Self {
        let spline = CubicCardinalSpline::new_catmull_rom(route.waypoints.iter().copied());
        let curve = spline.to_curve_cyclic().expect("a way has at least two waypoints");
        let pieces = curve.segments().len() * PIECES;
        let mut length = 0.0;
        let mut before = curve.position(0.0);
        let samples: Vec<(f32, f32)> = (0..=pieces)
            .map(|piece| {
                let parameter = piece as f32 / PIECES as f32;
                let point = curve.position(parameter);
                length += f64::from(point.distance(before));
                before = point;
                (length as f32, parameter)
            })
            .collect();
        let parameter = UnevenSampleAutoCurve::new(samples).expect("a way has finite waypoints");
        Self { curve, parameter, length, speed: route.speed.into(), start: route.start.into() }
    }

    /// Length of the way, m.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// Place and direction at a time in s.
    #[must_use]
    pub fn pose(&self, time: f64) -> Transform {
        self.pose_at(self.start + self.speed * time)
    }

    /// Place and direction at a length along the way in m.
    #[must_use]
    pub fn pose_at(&self, length: f64) -> Transform {
        let parameter = self.parameter.sample_clamped(length.rem_euclid(self.length) as f32);
        let position = self.curve.position(parameter);
        Transform::from_translation(position).looking_to(self.curve.velocity(parameter), Vec3::Y)
    }
}

/// A point that an entity faces wherever its track leads it, m.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct LooksAt(pub Vec3);

/// Puts everything on a track where it is at the time of the clock of the schedule: `FixedUpdate` for
/// runs that are alike to the bit, `Update` for a smooth ride on screen.
pub fn follow_tracks(
    time: Res<Time>,
    mut travellers: Query<(&Track, Option<&LooksAt>, &mut Transform)>,
) {
    for (track, looks_at, mut transform) in &mut travellers {
        let ahead = track.pose(time.elapsed_secs_f64());
        *transform = looks_at.map_or(ahead, |point| ahead.looking_at(point.0, Vec3::Y));
    }
}
