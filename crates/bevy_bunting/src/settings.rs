//! What holds for all cloths.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{LaneCount, StepSettings};

/// Settings for all cloths. They may be changed at any time.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothSettings {
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Density of the air, kg/m³; 1.225 at sea level.
    pub air_density: f32,
    /// How finely each level of detail is solved, the finest level first; the last holds for all
    /// levels after it.
    #[reflect(ignore)]
    pub steps: Vec<StepSettings>,
    /// Width of the batches; none takes what suits the number of cloths and the machine. It does
    /// not change the result by a bit.
    #[reflect(ignore)]
    pub lanes: Option<LaneCount>,
}

impl ClothSettings {
    /// How finely a level is solved.
    #[must_use]
    pub fn step(&self, level: usize) -> StepSettings {
        let step = self.steps.get(level).or(self.steps.last()).copied().unwrap_or_default();
        StepSettings { substeps: step.substeps.max(1), passes: step.passes.max(1), ..step }
    }
}

impl Default for ClothSettings {
    fn default() -> Self {
        Self {
            gravity: Vec3::new(0.0, -9.81, 0.0),
            air_density: 1.225,
            steps: vec![StepSettings::default()],
            lanes: None,
        }
    }
}
