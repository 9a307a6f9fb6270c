//! Wind: the velocity of the air.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use fastnoise_lite::{FastNoiseLite, NoiseType};

use crate::schedule::{ClothSystems, ClothTick};

/// Least length of a gust, m: that of a large flag. Smaller: gusts are shorter than the cloth that feels them
/// at its middle.
const LEAST_GUST_LENGTH: f32 = 2.0;

/// Moving air. The velocities of several fields are added up.
///
/// Gusts are simplex noise that the mean wind carries along (Taylor's hypothesis of frozen turbulence): their
/// length is the distance that the mean wind covers in 1/`gust_frequency`, at least 2 m, and a cloth downwind
/// feels a gust later. They depend on position, time and seed, and not on the frame rate. A cloth feels
/// the air at its middle.
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

    /// Velocity of the air (m/s) at a position in the world (m) and a time (s).
    #[must_use]
    pub fn velocity_at(&self, position: Vec3, seconds: f64) -> Vec3 {
        if self.gust_strength == 0.0 {
            return self.velocity;
        }
        let mut noise = FastNoiseLite::with_seed(self.seed);
        noise.set_noise_type(Some(NoiseType::OpenSimplex2));
        noise.set_frequency(Some(1.0));
        let speed = self.velocity.length();
        let length = (speed / self.gust_frequency).max(LEAST_GUST_LENGTH);
        // In a light wind gusts of the least length would be rarer than asked: they move faster than the air.
        let excess = (self.gust_frequency * length - speed).max(0.0) * Vec3::X;
        let carried = (self.velocity + excess).as_dvec3() * seconds;
        let at = ((position.as_dvec3() - carried) / f64::from(length)).as_vec3();
        // Layers of the noise at great distance are independent: one for each axis.
        let axis = |layer: f32| noise.get_noise_3d(at.x, at.y + 100.0 * layer, at.z);
        self.velocity + self.gust_strength * Vec3::new(axis(1.0), axis(2.0), axis(3.0))
    }
}

impl Default for WindField {
    fn default() -> Self {
        Self::steady(Vec3::ZERO)
    }
}

/// The air in this tick: all [`WindField`]s.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct TickWind {
    fields: Vec<WindField>,
    /// End of the tick, s.
    seconds: f64,
}

impl TickWind {
    /// Velocity of the air (m/s) at a position in the world (m): the sum of all fields. A field that is not
    /// finite counts as no wind at all.
    #[must_use]
    pub fn at(&self, position: Vec3) -> Vec3 {
        let velocities = self.fields.iter().map(|field| field.velocity_at(position, self.seconds));
        velocities.filter(|velocity| velocity.is_finite()).sum()
    }

    /// Whether the velocity of the air differs from that in another tick.
    pub(crate) fn differs_from(&self, other: &Self) -> bool {
        let has_gusts = self.fields.iter().any(|field| field.gust_strength != 0.0);
        self.fields != other.fields || (has_gusts && self.seconds != other.seconds)
    }
}

/// Collects the [`WindField`]s.
#[derive(Debug, Default)]
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindField>()
            .register_type::<TickWind>()
            .init_resource::<TickWind>()
            .add_systems(ClothTick, collect_winds.in_set(ClothSystems::Prepare));
    }
}

fn collect_winds(fields: Query<&WindField>, time: Res<Time>, mut wind: ResMut<TickWind>) {
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
