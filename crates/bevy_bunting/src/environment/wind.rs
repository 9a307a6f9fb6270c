//! Wind: the velocity of the air.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use fastnoise_lite::{FastNoiseLite, NoiseType};

use crate::schedule::{ClothSystems, ClothTick};

/// Air with the same velocity everywhere. The velocities of several fields are added up.
///
/// Gusts are simplex noise over the time of the tick, so they depend on the seed and not on the frame
/// rate.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct WindField {
    /// Mean velocity of the air relative to the world, m/s.
    pub velocity: Vec3,
    /// Greatest difference from the mean velocity along each axis, m/s.
    pub gust_strength: f32,
    /// Frequency of gusts, 1/s.
    pub gust_frequency: f32,
    /// Seed of the noise: fields with different seeds have independent gusts.
    pub seed: i32,
}

impl WindField {
    /// Wind of a velocity (m/s) without gusts.
    #[must_use]
    pub const fn steady(velocity: Vec3) -> Self {
        Self { velocity, gust_strength: 0.0, gust_frequency: 0.5, seed: 0 }
    }

    /// The same, with gusts of a strength (m/s), a frequency (1/s) and a seed.
    #[must_use]
    pub const fn with_gusts(mut self, strength: f32, frequency: f32, seed: i32) -> Self {
        self.gust_strength = strength;
        self.gust_frequency = frequency;
        self.seed = seed;
        self
    }

    /// Velocity of the air (m/s) at a time (s).
    #[must_use]
    pub fn velocity_at(&self, seconds: f64) -> Vec3 {
        if self.gust_strength == 0.0 {
            return self.velocity;
        }
        let mut noise = FastNoiseLite::with_seed(self.seed);
        noise.set_noise_type(Some(NoiseType::OpenSimplex2));
        noise.set_frequency(Some(1.0));
        let phase = (seconds * f64::from(self.gust_frequency)) as f32;
        // Rows of the noise at great distance are independent: one for each axis.
        let axis = |row: f32| noise.get_noise_2d(phase, 100.0 * row);
        self.velocity + self.gust_strength * Vec3::new(axis(1.0), axis(2.0), axis(3.0))
    }
}

impl Default for WindField {
    fn default() -> Self {
        Self::steady(Vec3::ZERO)
    }
}

/// Velocity of the air in this tick, m/s: the sum of all [`WindField`]s.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct TickWind(pub Vec3);

/// Adds up the [`WindField`]s.
#[derive(Debug, Default)]
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindField>()
            .register_type::<TickWind>()
            .init_resource::<TickWind>()
            .add_systems(ClothTick, add_up_winds.in_set(ClothSystems::Prepare));
    }
}

fn add_up_winds(fields: Query<&WindField>, time: Res<Time>, mut wind: ResMut<TickWind>) {
    let seconds = time.elapsed_secs_f64();
    let sum: Vec3 = fields.iter().map(|field| field.velocity_at(seconds)).sum();
    // A field that is not finite counts as no wind at all.
    wind.0 = if sum.is_finite() { sum } else { Vec3::ZERO };
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
            let at = |tick: i32| wind.velocity_at(f64::from(tick) / 64.0);
            let gust = at(tick) - Vec3::X;
            assert!(gust.abs().max_element() <= 2.0);
            assert!(at(tick).distance(at(tick + 1)) < 0.2);
            greatest = greatest.max(gust.length());
        }
        assert!(greatest > 1.0, "{greatest}");
        assert_ne!(wind.velocity_at(1.3), other.velocity_at(1.3));
    }
}
