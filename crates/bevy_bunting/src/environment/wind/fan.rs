//! Fans: round jets.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

use crate::environment::falloff::falloff;
use crate::motion::pose::PoseHistory;

/// Decay of the jet's velocity on its axis, in diameters of the nozzle (Pope, Turbulent Flows, 2000, 5.1).
const DECAY: f32 = 5.8;

/// Rate at which the jet's half width grows with the distance, m/m (Pope, 5.1).
const SPREAD: f32 = 0.094;

/// Coefficient of the velocity's profile (1 + a q²)⁻², which is one half at q = 1: √2 − 1 (Pope, 5.2).
const PROFILE: f32 = core::f32::consts::SQRT_2 - 1.0;

/// Radius of the jet, in half widths: the profile has fallen to one hundredth there.
const EDGE: f32 = 4.7;

/// Width of the fall to zero at the edge, in half widths. Smaller: the border is felt.
const EDGE_FALL: f32 = 1.5;

/// Part of the reach over which the jet falls to zero at its end.
const END_FALL: f32 = 0.25;

/// A fan that blows forwards, along the entity's −z: a round jet as a nozzle makes it, steady and without swirl. On the
/// axis the velocity stays for six diameters and then falls with the distance; the jet widens by one tenth of it.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_transform::prelude::*;
///
/// // A fan of half a metre that blows at 8 m/s along its -z.
/// let fan = (WindFan::new(8.0, 0.25), Transform::from_xyz(0.0, 1.0, 2.0));
/// # assert_eq!(fan.0.radius, 0.25);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, PoseHistory)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WindFan {
    /// Velocity of the air at the nozzle, m/s.
    pub speed: f32,
    /// Radius of the nozzle, m.
    pub radius: f32,
    /// Distance at which the jet ends, m; it falls to zero over the last quarter.
    pub reach: f32,
}

impl WindFan {
    /// A fan with a velocity (m/s) at a nozzle with a radius (m), which reaches sixty radii.
    #[must_use]
    pub const fn new(speed: f32, radius: f32) -> Self {
        Self { speed, radius, reach: 60.0 * radius }
    }

    /// Velocity of the air (m/s) at a position in the entity's frame (m).
    #[must_use]
    pub fn velocity_at(&self, position: Vec3) -> Vec3 {
        let along = -position.z;
        if along < 0.0 {
            return Vec3::ZERO;
        }
        let across = position.truncate().length() / self.half_width(along);
        let profile = 1.0 / (1.0 + PROFILE * across * across);
        let decay = (2.0 * DECAY * self.radius / along).min(1.0);
        let bounds =
            falloff(EDGE - across, EDGE_FALL) * falloff(self.reach - along, END_FALL * self.reach);
        Vec3::NEG_Z * (self.speed * decay * profile * profile * bounds)
    }

    /// Distance from the axis at which the velocity is half that on the axis, m.
    fn half_width(&self, along: f32) -> f32 {
        (SPREAD * along).max(self.radius)
    }

    /// Centre in the entity's frame and radius of a ball that contains the jet, m.
    pub(super) fn ball(&self) -> (Vec3, f32) {
        let (half, edge) = (0.5 * self.reach, EDGE * self.half_width(self.reach));
        (Vec3::NEG_Z * half, (half * half + edge * edge).sqrt())
    }
}

impl Default for WindFan {
    /// A large fan: 8 m/s at a nozzle with a radius of 0.4 m.
    fn default() -> Self {
        Self::new(8.0, 0.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jet_decays_and_widens() {
        let fan = WindFan { reach: 1e4, ..WindFan::new(10.0, 0.5) };
        let at = |x: f32, z: f32| fan.velocity_at(Vec3::new(x, 0.0, -z)).z;
        assert_eq!(at(0.0, 3.0), -10.0);
        assert!((at(0.0, 58.0) + 1.0).abs() < 1e-3);
        assert!((at(0.094 * 58.0, 58.0) + 0.5).abs() < 1e-3);
        assert_eq!([at(0.0, -0.1), at(40.0, 58.0), at(0.0, 1.1e4)], [0.0; 3]);
        let (centre, radius) = fan.ball();
        assert!(centre.distance(Vec3::new(0.094 * 4.6 * 1e4, 0.0, -1e4)) < radius);
    }
}
