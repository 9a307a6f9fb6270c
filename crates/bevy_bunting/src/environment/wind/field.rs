//! Fields of wind: a mean velocity with gusts.

use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::environment::wind::gusts::Gusts;
use crate::environment::wind::places::Places;

/// Least length of a gust, m: the size of a large flag. Smaller: gusts are shorter than the cloth, which
/// feels them at its middle only.
const LEAST_GUST_LENGTH: f32 = 2.0;

/// Moving air, everywhere or, with a [`WindRegion`](crate::WindRegion), where the entity is. The velocities of all winds
/// are added up.
///
/// Gusts are a sum of eight plane waves, free of divergence, that the mean wind carries along (Taylor's
/// hypothesis of frozen turbulence). Their length is the distance that the mean wind covers in
/// 1/`gust_frequency`, at least 2 m, and a cloth downwind feels a gust later. Gusts depend on position, time
/// and seed, and not on the frame rate. After a change of the mean velocity, gusts travel at the new
/// velocity. A cloth feels the air at its middle. A field that is not finite is reported as
/// [`ClothError::Wind`](crate::ClothError::Wind) and left out.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // 6 m/s along x, with gusts of up to 1.5 m/s, every two seconds or so, from seed 1.
/// let wind = WindField::steady(Vec3::new(6.0, 0.0, 0.0)).with_gusts(1.5, 0.5, 1);
/// # assert_eq!(wind.seed, 1);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(GustTravel)]
pub struct WindField {
    /// Mean velocity of the air relative to the world, m/s.
    pub velocity: Vec3,
    /// Greatest difference from the mean velocity along each axis, m/s; the root mean square of the
    /// difference is a quarter of this.
    pub gust_strength: f32,
    /// Frequency of gusts, 1/s.
    pub gust_frequency: f32,
    /// Seed of the gusts: fields with different seeds have independent gusts.
    pub seed: i32,
}

impl WindField {
    /// A steady wind of the given velocity (m/s), without gusts.
    #[must_use]
    pub const fn steady(velocity: Vec3) -> Self {
        Self { velocity, gust_strength: 0.0, gust_frequency: 0.5, seed: 0 }
    }

    /// The wind with gusts of a strength (m/s), a frequency (1/s) and a seed.
    #[must_use]
    pub const fn with_gusts(mut self, strength: f32, frequency: f32, seed: i32) -> Self {
        self.gust_strength = strength;
        self.gust_frequency = frequency;
        self.seed = seed;
        self
    }

    /// Velocity of the air (m/s) at a position in the world (m), after the mean wind has carried the gusts by
    /// `travel` of their lengths.
    #[must_use]
    pub fn velocity_at(&self, position: Vec3, travel: DVec3) -> Vec3 {
        MovingAir::new(self, travel).at(&Places::of(&[position])).get(0)
    }

    /// Distance that gusts travel in a second, in lengths of a gust; zero without gusts.
    #[must_use]
    pub fn travel_rate(&self) -> DVec3 {
        if self.gust_strength == 0.0 || !self.velocity.is_finite() {
            return DVec3::ZERO;
        }
        // In a light wind, gusts of the least length would be rarer than asked: such gusts move faster than
        // the air.
        let frequency = f64::from(self.gust_frequency);
        let along = self.velocity.try_normalize().unwrap_or(Vec3::X).as_dvec3();
        let rate = along * frequency.max(f64::from(self.velocity.length() / self.gust_length()));
        if rate.is_finite() { rate } else { DVec3::ZERO }
    }

    /// Length of a gust, m.
    pub(super) fn gust_length(&self) -> f32 {
        (self.velocity.length() / self.gust_frequency).max(LEAST_GUST_LENGTH)
    }
}

/// Distance that the mean wind has carried the gusts of a [`WindField`], in lengths of a gust. The distance
/// is summed tick by tick, so that gusts stay continuous when the field's velocity changes. A [`ShiftOrigin`](crate::ShiftOrigin) adds
/// its displacement, so that gusts stay where they are.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct GustTravel(pub DVec3);

impl Default for WindField {
    fn default() -> Self {
        Self::steady(Vec3::ZERO)
    }
}

/// The air of one [`WindField`] in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct MovingAir {
    /// Mean velocity, m/s.
    velocity: Vec3,
    gusts: Option<Gusts>,
}

impl MovingAir {
    pub fn new(field: &WindField, travel: DVec3) -> Self {
        let WindField { velocity, gust_strength, seed, .. } = *field;
        let gusts = || Gusts::new(seed, gust_strength, field.gust_length(), travel);
        Self { velocity, gusts: (gust_strength != 0.0).then(gusts) }
    }

    /// Moves the gusts along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        if let Some(gusts) = &mut self.gusts {
            gusts.shift(by);
        }
    }

    /// The velocity that this air has everywhere (m/s), unless it has gusts.
    pub fn steady(&self) -> Option<Vec3> {
        self.gusts.is_none().then_some(self.velocity)
    }

    /// Velocities (m/s) at positions in the world (m).
    pub fn at(&self, positions: &Places) -> Places {
        let mean = Places::splat(self.velocity);
        self.gusts.as_ref().map_or(mean, |gusts| mean.plus(&gusts.at(positions)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_are_bounded_seeded_and_smooth() {
        let wind = WindField::steady(Vec3::X).with_gusts(2.0, 0.5, 7);
        let other = WindField { seed: 8, ..wind };
        let mut greatest = 0.0_f32;
        for tick in 0..6400 {
            let travel = |tick: i32| wind.travel_rate() * f64::from(tick) / 64.0;
            let at = |tick: i32| wind.velocity_at(Vec3::Y, travel(tick));
            let gust = at(tick) - Vec3::X;
            assert!(gust.abs().max_element() <= 2.0);
            assert!(at(tick).distance(at(tick + 1)) < 0.2);
            greatest = greatest.max(gust.length());
        }
        assert!(greatest > 1.0, "{greatest}");
        let at = |wind: WindField| wind.velocity_at(Vec3::Y, 1.3 * wind.travel_rate());
        assert_ne!(at(wind), at(other));
    }
}
