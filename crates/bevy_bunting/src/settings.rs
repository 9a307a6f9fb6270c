//! What holds for all cloths.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{Drive, LaneCount, StepLimits};

/// Settings for all cloths. They may be changed at any time.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothSettings {
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Density of the air, kg/m³; 1.225 at sea level.
    pub air_density: f32,
    /// How finely each level of detail is solved, the finest level first; the last holds for all
    /// levels after it. Within these limits substeps are chosen for each fabric.
    #[reflect(ignore)]
    pub steps: Vec<StepLimits>,
    /// Width of the batches; none takes what suits the number of cloths and the machine. It does
    /// not change the result by a bit.
    #[reflect(ignore)]
    pub lanes: Option<LaneCount>,
}

impl ClothSettings {
    /// How finely a level may be solved.
    #[must_use]
    pub fn limits(&self, level: usize) -> StepLimits {
        self.steps.get(level).or(self.steps.last()).cloned().unwrap_or_default()
    }
}

impl Default for ClothSettings {
    /// Gravity and air at sea level; the finest level takes two substeps or more, the others one or more.
    fn default() -> Self {
        let finest = StepLimits::default();
        let coarse = StepLimits { substeps: 1..=*finest.substeps.end(), ..finest.clone() };
        Self {
            gravity: Drive::default().gravity,
            air_density: Drive::default().air_density,
            steps: vec![finest, coarse],
            lanes: None,
        }
    }
}
