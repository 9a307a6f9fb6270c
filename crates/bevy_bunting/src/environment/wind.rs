//! Moving air.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use fastnoise_lite::{FastNoiseLite, NoiseType};

use crate::schedule::{ClothSystems, ClothTick};

/// Least length of a gust, m: about that of a flag, as a cloth feels the wind at its middle.
const LEAST_GUST: f32 = 2.0;

/// Moving air. Several fields add up.
///
/// Gusts are noise that is carried along by the mean wind (Taylor's hypothesis of frozen turbulence): one
/// gust is as long as the mean wind goes in 1/`gust_frequency`, at least 2 m, and what stands downwind feels
/// it later. They depend on place, time and seed, and not on the frame rate. A cloth feels the air at its
/// middle.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct WindField {
    /// Mean velocity of the air relative to the world, m/s.
    pub velocity: Vec3,
    /// Greatest departure from the mean along each axis, m/s.
    pub gust_strength: f32,
    /// How often gusts come, 1/s.
    pub gust_frequency: f32,
    /// Chooses the gusts.
    pub seed: i32,
}

impl WindField {
    /// Wind without gusts, m/s.
    #[must_use]
    pub const fn steady(velocity: Vec3) -> Self {
        Self { velocity, gust_strength: 0.0, gust_frequency: 0.5, seed: 0 }
    }

    /// The same, with gusts of a strength (m/s) and frequency (1/s).
    #[must_use]
    pub const fn with_gusts(mut self, strength: f32, frequency: f32, seed: i32) -> Self {
        self.gust_strength = strength;
        self.gust_frequency = frequency;
        self.seed = seed;
        self
    }

    /// Velocity of the air at a place in the world (m) after `seconds`, m/s.
    #[must_use]
    pub fn velocity_at(&self, place: Vec3, seconds: f64) -> Vec3 {
        if self.gust_strength == 0.0 {
            return self.velocity;
        }
        let mut noise = FastNoiseLite::with_seed(self.seed);
        noise.set_noise_type(Some(NoiseType::OpenSimplex2));
        noise.set_frequency(Some(1.0));
        let speed = self.velocity.length();
        let length = (speed / self.gust_frequency).max(LEAST_GUST);
        // In a light wind gusts go faster than the air, lest they come more seldom.
        let hurry = (self.gust_frequency * length - speed).max(0.0) * Vec3::X;
        let carried = (self.velocity + hurry).as_dvec3() * seconds;
        let at = ((place.as_dvec3() - carried) / f64::from(length)).as_vec3();
        // Rows of the noise far apart are independent.
        let axis = |row: f32| noise.get_noise_3d(at.x, at.y + 100.0 * row, at.z);
        self.velocity + self.gust_strength * Vec3::new(axis(1.0), axis(2.0), axis(3.0))
    }
}

impl Default for WindField {
    fn default() -> Self {
        Self::steady(Vec3::ZERO)
    }
}

/// The air in this tick: all fields.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct TickWind {
    fields: Vec<WindField>,
    /// End of the tick, s.
    seconds: f64,
}

impl TickWind {
    /// Velocity of the air at a place in the world (m), m/s: the sum of all fields. One that is not finite
    /// counts for nothing.
    #[must_use]
    pub fn at(&self, place: Vec3) -> Vec3 {
        let velocities = self.fields.iter().map(|field| field.velocity_at(place, self.seconds));
        velocities.filter(|velocity| velocity.is_finite()).sum()
    }

    /// Whether the air blows otherwise than in another tick.
    pub(crate) fn differs_from(&self, other: &Self) -> bool {
        let gusty = self.fields.iter().any(|field| field.gust_strength != 0.0);
        self.fields != other.fields || (gusty && self.seconds != other.seconds)
    }
}

/// Shows the [`WindField`]s to the cloths.
#[derive(Debug, Default)]
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindField>()
            .register_type::<TickWind>()
            .init_resource::<TickWind>()
            .add_systems(ClothTick, note_winds.in_set(ClothSystems::Prepare));
    }
}

fn note_winds(fields: Query<&WindField>, time: Res<Time>, mut wind: ResMut<TickWind>) {
    wind.seconds = time.elapsed_secs_f64();
    wind.fields.clear();
    wind.fields.extend(&fields);
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
            let at = |tick: i32| wind.velocity_at(Vec3::Y, f64::from(tick) / 64.0);
            let gust = at(tick) - Vec3::X;
            assert!(gust.abs().max_element() <= 2.0);
            assert!(at(tick).distance(at(tick + 1)) < 0.2);
            greatest = greatest.max(gust.length());
        }
        assert!(greatest > 1.0, "{greatest}");
        let at = |wind: WindField| wind.velocity_at(Vec3::Y, 1.3);
        assert_ne!(at(wind), at(other));
    }
}
