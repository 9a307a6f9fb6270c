//! Motion along a closed path at a constant speed.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_math::cubic_splines::{CubicCardinalSpline, CubicCurve, CyclicCubicGenerator};
use bevy_math::curve::{Curve, UnevenSampleAutoCurve};
use bevy_time::Time;
use bevy_transform::components::Transform;

use crate::scene::Route;

/// Number of chords between two waypoints whose lengths approximate the length of the curve. Fewer: the speed
/// is not constant in bends.
const CHORDS: usize = 256;

/// A closed path of an entity, which faces ahead along −z: its pose is a function of time only.
#[derive(Component, Clone, Debug)]
pub struct Track {
    curve: CubicCurve<Vec3>,
    /// Parameter of the curve, over the length along it in m.
    parameter: UnevenSampleAutoCurve<f32>,
    /// Length of the path, m.
    length: f64,
    /// Speed along the path, m/s.
    speed: f64,
    /// Length along the path at time 0, m.
    start: f64,
}

impl Track {
    /// The path of a route: a closed Catmull–Rom curve through its waypoints.
    ///
    /// # Panics
    ///
    /// If there are fewer than two waypoints, or a waypoint is not finite. [`load`](crate::load) reports both
    /// as errors.
    #[must_use]
    pub fn new(route: &Route) -> Self {
        let spline = CubicCardinalSpline::new_catmull_rom(route.waypoints.iter().copied());
        let curve = spline.to_curve_cyclic().expect("a route has at least two waypoints");
        let chords = curve.segments().len() * CHORDS;
        let mut length = 0.0;
        let mut before = curve.position(0.0);
        let samples: Vec<(f32, f32)> = (0..=chords)
            .map(|chord| {
                let parameter = chord as f32 / CHORDS as f32;
                let point = curve.position(parameter);
                length += f64::from(point.distance(before));
                before = point;
                (length as f32, parameter)
            })
            .collect();
        let parameter = UnevenSampleAutoCurve::new(samples).expect("a route has finite waypoints");
        Self { curve, parameter, length, speed: route.speed.into(), start: route.start.into() }
    }

    /// Length of the path, m.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// The pose at a time (s).
    #[must_use]
    pub fn pose(&self, time: f64) -> Transform {
        self.pose_at(self.start + self.speed * time)
    }

    /// The pose at a length along the path (m).
    #[must_use]
    pub fn pose_at(&self, length: f64) -> Transform {
        let parameter = self.parameter.sample_clamped(length.rem_euclid(self.length) as f32);
        let position = self.curve.position(parameter);
        Transform::from_translation(position).looking_to(self.curve.velocity(parameter), Vec3::Y)
    }
}

/// The point that an entity on a track faces, m.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct LooksAt(pub Vec3);

/// Moves the entities with a [`Track`] to their pose at the current time. In `FixedUpdate` this is the time
/// of the fixed clock, for runs with reproducible bits; in `Update` that of the virtual clock, for smooth
/// motion on screen.
pub fn follow_tracks(
    time: Res<Time>,
    mut entities: Query<(&Track, Option<&LooksAt>, &mut Transform)>,
) {
    for (track, looks_at, mut transform) in &mut entities {
        let ahead = track.pose(time.elapsed_secs_f64());
        *transform = looks_at.map_or(ahead, |point| ahead.looking_at(point.0, Vec3::Y));
    }
}
