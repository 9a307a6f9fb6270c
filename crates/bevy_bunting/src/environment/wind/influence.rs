//! The part of the wind that a cloth feels.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;

/// The part of the air's motion relative to its frame that a cloth feels, for shelter: 1 in the open, which is the default
/// without this component; 0 behind closed doors, where the air moves with the frame, as in a bus that drives. More than
/// 1 makes the cloth feel more wind than there is.
///
/// A factor that is not finite, or negative, is reported as [`ClothError::Influence`] and counts as 1.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // In the lee of a wall.
/// let washing = (ClothMesh::grid(17, 17, 0.5, 0.5), WindInfluence(0.2));
/// # assert_eq!(washing.1.0, 0.2);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct WindInfluence(pub f32);

impl Default for WindInfluence {
    fn default() -> Self {
        Self(1.0)
    }
}

impl WindInfluence {
    /// The wind (m/s) that a cloth feels whose frame moves at `ride` (m/s).
    pub(crate) fn felt(self, wind: Vec3, ride: Vec3) -> Vec3 {
        if self.is_valid() { ride + (wind - ride) * self.0 } else { wind }
    }

    fn is_valid(self) -> bool {
        self.0 >= 0.0 && self.0.is_finite()
    }
}

/// Reports factors that cannot be used.
pub(super) fn report_influences(
    changed: Query<(Entity, &WindInfluence), Changed<WindInfluence>>,
    mut commands: Commands,
) {
    for (entity, influence) in &changed {
        if !influence.is_valid() {
            ClothFailed::report(&mut commands, entity, ClothError::Influence { entity });
        }
    }
}
