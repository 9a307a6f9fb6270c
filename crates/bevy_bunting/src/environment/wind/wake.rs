//! Wakes: air that a moving body drags along.

use core::f32::consts::PI;
use std::collections::VecDeque;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

use crate::motion::pose::PoseHistory;

/// Time after which a wake has died down, s. Longer: trails cost more.
const LIFETIME: f32 = 5.0;

/// Time between two points of the trail, s: 6 m at 25 m/s. Longer: the wakes of turning vehicles have corners.
const SPACING: f32 = 0.25;

/// Growth of the wake's width: σ = 0.6 (C_d A x)^⅓ at the distance x behind the body, about that of the round turbulent
/// wakes that are like themselves at all distances. Larger: the wake is wider and weaker.
const SPREAD: f32 = 0.6;

/// Radius of the wake, in widths σ: 1 % of the velocity on its axis is left there.
const EDGE: f32 = 3.0;

/// Change of place from one tick to the next that is no motion, m: the trail ends there.
const JUMP: f32 = 1.0;

/// Makes the entity drag air along: a round turbulent wake on the path that the entity's origin took in the last five
/// seconds. The body loses as much momentum to the air as its drag is; on the axis the air moves with the body where the
/// body is, and the more slowly the farther the body has gone on. The air itself is at rest: other winds do not carry the
/// wake away.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_transform::prelude::*;
///
/// // The air behind a truck of 6 square metres of drag area.
/// let truck = (WindWake::new(6.0), Transform::default());
/// # assert_eq!(truck.0.drag_area, 6.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, PoseHistory, WakeTrail)]
pub struct WindWake {
    /// Drag coefficient times frontal area, C_d A, m²: 0.7 for a car, 6 for a lorry.
    pub drag_area: f32,
}

impl WindWake {
    /// The wake of a body with the given drag coefficient times frontal area (m²).
    #[must_use]
    pub const fn new(drag_area: f32) -> Self {
        Self { drag_area }
    }
}

impl Default for WindWake {
    /// The wake of a lorry.
    fn default() -> Self {
        Self::new(6.0)
    }
}

/// The path of a [`WindWake`]'s body in the last seconds.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WakeTrail(VecDeque<TrailPoint>);

/// A place that the body has passed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct TrailPoint {
    /// In the world, m.
    at: Vec3,
    /// Velocity of the body there, m/s.
    velocity: Vec3,
    /// Time since then, s.
    age: f32,
}

impl WakeTrail {
    /// Moves the body to a place (m) in a tick of the given length (s).
    pub(super) fn advance(&mut self, (from, to): (Vec3, Vec3), tick: f32) {
        let trail = &mut self.0;
        if trail.front().is_some_and(|body| body.at.distance(from) > JUMP) {
            trail.clear();
        }
        trail.iter_mut().for_each(|point| point.age += tick);
        while trail.back().is_some_and(|oldest| oldest.age > LIFETIME) {
            trail.pop_back();
        }
        // The first point is the body itself, which moves on until the next point is due.
        if trail.len() > 1 && trail[1].age < SPACING {
            trail.pop_front();
        }
        trail.push_front(TrailPoint { at: to, velocity: (to - from) / tick, age: 0.0 });
    }

    /// Moves the path along with the world, m.
    pub(super) fn shift(&mut self, by: Vec3) {
        self.0.iter_mut().for_each(|point| point.at += by);
    }

    /// The place on the path that is nearest to a position (m), and its distance, m.
    fn nearest(&self, position: Vec3) -> (TrailPoint, f32) {
        let mut nearest = (TrailPoint::default(), f32::INFINITY);
        let mut newer = self.0.front();
        for older in &self.0 {
            let from = newer.unwrap_or(older);
            let along = older.at - from.at;
            let part =
                along.dot(position - from.at) / along.length_squared().max(f32::MIN_POSITIVE);
            let part = part.clamp(0.0, 1.0);
            let point = TrailPoint {
                at: from.at + along * part,
                velocity: from.velocity.lerp(older.velocity, part),
                age: from.age + (older.age - from.age) * part,
            };
            let distance = position.distance(point.at);
            if distance < nearest.1 {
                nearest = (point, distance);
            }
            newer = Some(older);
        }
        nearest
    }

    /// Centre and radius of a ball that contains the wake of a body with a drag area (m²), m; none where nothing moves.
    pub(super) fn ball(&self, drag_area: f32) -> Option<(Vec3, f32)> {
        let moves = self.0.iter().any(|point| point.velocity != Vec3::ZERO);
        let (lowest, highest) =
            self.0.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lowest, highest), point| {
                (lowest.min(point.at), highest.max(point.at))
            });
        let width = |point: &TrailPoint| width(drag_area, point);
        let widest = self.0.iter().map(width).fold(0.0, f32::max);
        moves.then(|| ((lowest + highest) * 0.5, 0.5 * lowest.distance(highest) + EDGE * widest))
    }

    /// Velocity of the air (m/s) at a position in the world (m) in the wake of a body with a drag area (m²).
    pub(super) fn velocity_at(&self, position: Vec3, drag_area: f32) -> Vec3 {
        let (point, distance) = self.nearest(position);
        let width = width(drag_area, &point);
        let across = distance / width;
        // The momentum of the wake: U 2π σ² u = ½ C_d A U².
        let on_axis = drag_area / (4.0 * PI * width * width);
        point.velocity * (on_axis * libm::expf(-0.5 * across * across))
    }
}

/// Width σ of the wake at a place, m: on its axis at the body the air has the body's velocity.
fn width(drag_area: f32, point: &TrailPoint) -> f32 {
    let at_body = (drag_area / (4.0 * PI)).sqrt();
    let behind = point.velocity.length() * point.age;
    libm::cbrtf(at_body * at_body * at_body + SPREAD * SPREAD * SPREAD * drag_area * behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: f32 = 1.0 / 64.0;

    fn trail(seconds: f32, path: impl Fn(f32) -> Vec3) -> WakeTrail {
        let mut trail = WakeTrail::default();
        for tick in 0..(seconds / TICK) as i32 {
            let at = |tick: i32| path(tick as f32 * TICK);
            trail.advance((at(tick), at(tick + 1)), TICK);
        }
        trail
    }

    #[test]
    fn the_wake_carries_the_momentum_of_the_drag() {
        let wake = trail(4.0, |time| Vec3::X * 20.0 * time);
        for behind in [2.0, 10.0, 40.0] {
            // The flux of momentum U ∫ u dA is ½ C_d A U².
            let flux: f32 = (0..400)
                .map(|ring| {
                    let radius = (ring as f32 + 0.5) * 0.1;
                    let at = Vec3::new(80.0 - behind, radius, 0.0);
                    wake.velocity_at(at, 6.0).x * 2.0 * PI * radius * 0.1
                })
                .sum();
            assert!((flux / (0.5 * 6.0 * 20.0) - 1.0).abs() < 0.01, "{flux} {behind} m behind");
        }
        let at_body = wake.velocity_at(Vec3::X * 80.0, 6.0);
        assert!(at_body.distance(Vec3::X * 20.0) < 1e-3, "{at_body}");
    }

    #[test]
    fn the_wake_lies_on_the_path_and_stays_when_the_body_stops() {
        let path = |time: f32| {
            let time = time.min(3.0);
            Vec3::new(libm::cosf(time), 0.0, libm::sinf(time)) * 10.0
        };
        let wake = trail(4.0, path);
        let air = |time: f32| wake.velocity_at(path(time), 1.0);
        let speeds = [2.8, 2.0, 1.0].map(|time| air(time).length());
        assert!(speeds.is_sorted_by(|a, b| a > b) && speeds[2] > 0.1, "{speeds:?}");
        let along = air(2.0).normalize().dot(Vec3::new(-libm::sinf(2.0), 0.0, libm::cosf(2.0)));
        assert!(along > 0.98, "{along}");
        assert!(wake.velocity_at(Vec3::ZERO, 1.0).length() < 0.01);
        let (centre, radius) = wake.ball(1.0).expect("a wake");
        assert!(centre.distance(path(0.0)) < radius);
    }

    #[test]
    fn trails_end_at_jumps_and_are_short() {
        let wake = trail(60.0, |time| Vec3::X * time);
        assert!(wake.0.len() <= (LIFETIME / SPACING) as usize + 3, "{} points", wake.0.len());
        let mut jumped = wake;
        jumped.advance((Vec3::Y * 50.0, Vec3::Y * 50.0), TICK);
        assert_eq!(jumped.0.len(), 1);
        assert_eq!(jumped.ball(6.0), None);
    }
}
