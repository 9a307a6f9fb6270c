//! A constant acceleration of one cloth.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;

/// An acceleration of the whole cloth besides gravity, along the world's axes, m/s²: the negative of gravity makes a cloth
/// weightless. The solver treats both alike. One that is not finite is reported as [`ClothError::Acceleration`] and counts
/// as zero.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // A balloon's silk, which the hot air lifts.
/// let envelope = (ClothMesh::grid(33, 33, 4.0, 4.0), ClothAcceleration(Vec3::new(0.0, 12.0, 0.0)));
/// # assert!(envelope.1.0.y > 9.81);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothAcceleration(pub Vec3);

impl ClothAcceleration {
    /// The acceleration that acts, m/s².
    pub(crate) fn acting(self) -> Vec3 {
        if self.0.is_finite() { self.0 } else { Vec3::ZERO }
    }
}

/// Reports accelerations that are not finite.
pub(super) fn report_accelerations(
    changed: Query<(Entity, &ClothAcceleration), Changed<ClothAcceleration>>,
    mut commands: Commands,
) {
    for (entity, acceleration) in &changed {
        if !acceleration.0.is_finite() {
            ClothFailed::report(&mut commands, entity, ClothError::Acceleration { entity });
        }
    }
}
