//! Settings for all cloths.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{Drive, LaneCount, StepLimits};

/// Settings for all cloths. The settings may be changed at any time.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // On the moon; insert it as a resource.
/// let gravity = Vec3::new(0.0, -1.62, 0.0);
/// let settings = ClothSettings { gravity, air_density: 0.0, ..ClothSettings::default() };
/// # assert_eq!(settings.steps.len(), 2);
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothSettings {
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Density of the air, kg/m³; 1.225 at sea level.
    pub air_density: f32,
    /// Limits of substeps and passes at each level of detail, the finest level first; the last entry also
    /// holds for all coarser levels. Within these limits each cloth's number of substeps follows from
    /// gravity, its length and its spacing, and from what acts on it, see [`ClothEffort`](crate::ClothEffort).
    pub steps: Vec<StepLimits>,
    /// Number of lanes in each batch. By default it follows from the number of cloths and the instruction
    /// set. It does not change the bits of the result.
    pub lanes: Option<LaneCount>,
    /// Whether cloths may take more substeps than they need where that lets them share a batch with cloths that need more,
    /// and all together cost less. By default they may: then the bits of a cloth depend on which others of its grid or
    /// fabric there are, and what those need. Otherwise they depend on no other cloth, and flags in gusts cost up to
    /// half as much again.
    pub share_batches: bool,
}

impl ClothSettings {
    /// Limits of substeps and passes at a level.
    #[must_use]
    pub fn limits(&self, level: usize) -> StepLimits {
        self.steps.get(level).or(self.steps.last()).cloned().unwrap_or_default()
    }
}

impl Default for ClothSettings {
    /// Earth's gravity and air at sea level; at least 120 substeps a second at the finest level, at least 60
    /// at others.
    fn default() -> Self {
        let finest = StepLimits::default();
        let coarse = StepLimits { rate: finest.rate / 2, ..finest.clone() };
        Self {
            gravity: Drive::default().gravity,
            air_density: Drive::default().air_density,
            steps: vec![finest, coarse],
            lanes: None,
            share_batches: true,
        }
    }
}
