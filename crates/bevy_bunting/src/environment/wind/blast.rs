//! Blasts: a front that travels outward, and the wind behind it.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

use crate::motion::pose::PoseHistory;

/// Time after the front at which the wind has died down, in durations: it is then 0.3 % of its peak.
const TAIL: f32 = 8.0;

/// Velocity below which a blast is not felt, m/s.
const LEAST_SPEED: f32 = 0.05;

/// A blast at the entity's place. Its front travels outward at a constant speed. At the front the air suddenly moves
/// outward, most `radius` away from the centre and beyond it in inverse proportion to the distance; then it slows down, and
/// flows back more slowly: u = u₀ (1 − t/T) e^(−t/T) at the time t after the front (Friedlander 1946).
///
/// Cloth feels the mean over a tick, so that it gets the whole gust whatever the ticks are. The component is removed when
/// the blast is over. A value that is not finite, and a duration or a speed of the front that is not positive, make no
/// wind and are reported as [`ClothError::Wind`](crate::ClothError::Wind) when the blast is new.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_transform::prelude::*;
///
/// // 60 m/s at 2 m from here, once.
/// let blast = (WindBlast::new(60.0, 2.0), Transform::from_xyz(5.0, 0.0, 0.0));
/// # assert_eq!(blast.0.speed, 60.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, PoseHistory)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WindBlast {
    /// Greatest velocity of the air, m/s.
    pub speed: f32,
    /// Distance from the centre at which the air has this velocity, m.
    pub radius: f32,
    /// Speed of the front, m/s.
    pub front_speed: f32,
    /// Time T for which the air flows outward, s.
    pub duration: f32,
    /// Time since the blast began, s. Each tick adds its length; a blast with a negative age begins later.
    pub age: f32,
}

impl WindBlast {
    /// A blast with the given greatest velocity of the air (m/s) at a distance from the centre (m), whose front travels
    /// at the speed of sound, 340 m/s, and behind which the air flows outward for 0.15 s.
    #[must_use]
    pub const fn new(speed: f32, radius: f32) -> Self {
        Self { speed, radius, front_speed: 340.0, duration: 0.15, age: 0.0 }
    }

    /// Time at which the front is at a distance (m) from the centre, s after the blast began.
    #[must_use]
    pub fn arrival(&self, distance: f32) -> f32 {
        distance / self.front_speed
    }

    /// Mean velocity of the air (m/s) at a position relative to the centre (m) in the last `tick` seconds.
    #[must_use]
    pub fn velocity_at(&self, position: Vec3, tick: f32) -> Vec3 {
        let distance = position.length();
        // Times since the front passed, in durations. The integral of (1 − t) e^(−t) is t e^(−t).
        let since = |age: f32| ((age - self.arrival(distance)) / self.duration).max(0.0);
        let flowed = |time: f32| time * libm::expf(-time);
        let mean =
            (flowed(since(self.age)) - flowed(since(self.age - tick))) * self.duration / tick;
        // Outward with speed r/R within the radius R, and with R/r beyond.
        let squared = (self.radius * self.radius).max(distance * distance);
        if squared <= 0.0 || mean == 0.0 {
            return Vec3::ZERO;
        }
        position * (self.speed * mean * self.radius / squared)
    }

    /// Radius of the ball that the blast has reached, m; none before it begins, and when it is over.
    pub(super) fn reached(&self) -> Option<f32> {
        let travelled = self.age * self.front_speed;
        let far = self.farthest();
        let is_over = travelled > far + TAIL * self.duration * self.front_speed;
        (travelled > 0.0 && !is_over).then_some(travelled.min(far))
    }

    /// Whether the blast has passed everywhere.
    pub(super) fn is_over(&self) -> bool {
        self.age > self.arrival(self.farthest()) + TAIL * self.duration
    }

    /// Distance from the centre beyond which the blast is not felt, m.
    fn farthest(&self) -> f32 {
        self.radius * (self.speed.abs() / LEAST_SPEED).max(1.0)
    }
}

impl Default for WindBlast {
    /// A blast of 40 m/s three metres from its centre.
    fn default() -> Self {
        Self::new(40.0, 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sum of the velocities in ticks of a length (s) times that length, up to a time (s), at a distance (m), m.
    fn flowed(tick: f32, seconds: f32, distance: f32) -> f32 {
        let ticks = (seconds / tick) as i32;
        let at = |index: i32| {
            let blast = WindBlast { age: (index + 1) as f32 * tick, ..WindBlast::default() };
            blast.velocity_at(Vec3::X * distance, tick).x * tick
        };
        (0..ticks).map(at).sum()
    }

    #[test]
    fn the_front_arrives_in_its_tick() {
        let tick = 1.0 / 64.0;
        for distance in [5.0, 20.0, 85.0] {
            let due = (distance / 340.0 / tick) as i32;
            for index in 0..40 {
                let blast = WindBlast { age: (index + 1) as f32 * tick, ..WindBlast::default() };
                let blows = blast.velocity_at(Vec3::Z * distance, tick) != Vec3::ZERO;
                assert_eq!(blows, index >= due, "{distance} m, tick {index} of {due}");
            }
        }
    }

    #[test]
    fn long_ticks_carry_the_air_as_far_as_short_ones() {
        let [long, short] = [1.0 / 16.0, 1.0 / 1024.0].map(|tick| flowed(tick, 0.25, 10.0));
        // The integral at 0.25 s, 0.25 − 10/340 s after the front.
        let time = (0.25 - 10.0 / 340.0) / 0.15;
        let exact = 40.0 * 0.3 * 0.15 * time * libm::expf(-time);
        assert!(
            (long / exact - 1.0).abs() < 1e-4 && (short / exact - 1.0).abs() < 1e-3,
            "{long} {short} {exact}"
        );
    }
}
