//! What acts on a cloth in a tick besides its attachment and colliders: gravity and the air.

use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::Time;
use bunting_solver::{Drive, FrameMotion};

use crate::environment::forces::acceleration::ClothAcceleration;
use crate::environment::wind::influence::WindInfluence;
use crate::environment::wind::places::{PLACES, Places};
use crate::environment::wind::tick_wind::TickWind;
use crate::motion::inertia::ride;
use crate::settings::ClothSettings;

/// Gravity and air in this tick.
#[derive(SystemParam)]
pub(crate) struct Surroundings<'w> {
    settings: Res<'w, ClothSettings>,
    wind: Res<'w, TickWind>,
    time: Res<'w, Time>,
}

/// The components of a cloth on which the effect of its surroundings depends.
#[derive(QueryData)]
pub(crate) struct Exposure {
    influence: Option<&'static WindInfluence>,
    acceleration: Option<&'static ClothAcceleration>,
}

impl ExposureItem<'_, '_> {
    /// Acceleration of the cloth's own along the world's axes, m/s².
    pub fn acceleration(&self) -> Vec3 {
        self.acceleration.map_or(Vec3::ZERO, |acceleration| acceleration.acting())
    }
}

impl Surroundings<'_> {
    /// The length of the tick, s.
    pub fn tick(&self) -> f32 {
        self.time.delta_secs()
    }

    /// What acts on a cloth in a frame with this pose and motion, where the air has a velocity (m/s). Gravity and wind are
    /// rotated from the world's axes to those of the frame. An acceleration of the cloth's own adds to gravity.
    pub fn drive(
        &self,
        wind: Vec3,
        frame: Isometry3d,
        motion: FrameMotion,
        exposure: &ExposureItem,
    ) -> Drive {
        let inverse = frame.rotation.inverse();
        let (mut gravity, air_density) = self.gravity_and_air();
        if exposure.acceleration.is_some() {
            gravity += exposure.acceleration();
        }
        let wind = self.felt(wind, frame, &motion, exposure);
        Drive { motion, gravity: inverse * gravity, wind, air_density }
    }

    /// The part of a wind (m/s) that a cloth feels, m/s, along the axes of the frame.
    pub fn felt(
        &self,
        wind: Vec3,
        frame: Isometry3d,
        motion: &FrameMotion,
        exposure: &ExposureItem,
    ) -> Vec3 {
        let wind = frame.rotation.inverse() * wind;
        match exposure.influence {
            Some(influence) => influence.felt(wind, ride(motion, self.tick())),
            None => wind,
        }
    }

    /// Overwrites `winds` by the velocities of the air (m/s) at positions in the world (m).
    pub fn winds_at(&self, positions: impl IntoIterator<Item = Vec3>, winds: &mut Vec<Vec3>) {
        winds.clear();
        if let Some(wind) = self.wind.same_everywhere() {
            winds.extend(positions.into_iter().map(|_| wind));
            return;
        }
        winds.extend(positions);
        for places in winds.chunks_mut(PLACES) {
            let velocities = self.wind.at_places(&Places::of(places));
            for (place, wind) in places.iter_mut().enumerate() {
                *wind = velocities.get(place);
            }
        }
    }

    /// Velocity of the air (m/s) at a position in the world (m).
    pub fn wind_at(&self, position: Vec3) -> Vec3 {
        self.wind.at(position)
    }

    /// Gravity (m/s²) and the density of the air (kg/m³). A value that is not finite, or a negative density, counts as
    /// zero.
    fn gravity_and_air(&self) -> (Vec3, f32) {
        let (gravity, density) = (self.settings.gravity, self.settings.air_density);
        (
            if gravity.is_finite() { gravity } else { Vec3::ZERO },
            if is_density(density) { density } else { 0.0 },
        )
    }
}

fn is_density(density: f32) -> bool {
    density >= 0.0 && density.is_finite()
}

/// Logs settings that are not valid, whenever they change.
pub(super) fn report_settings(settings: Res<ClothSettings>) {
    let (gravity, density) = (settings.gravity, settings.air_density);
    if settings.is_changed() && !(gravity.is_finite() && is_density(density)) {
        log::error!(
            "ClothSettings: gravity {gravity} and air density {density} must be finite, and the density not \
             negative; an invalid value counts as zero"
        );
    }
}
