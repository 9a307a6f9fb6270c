//! Reports inertia that cannot be used.

use bevy_ecs::prelude::*;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::motion::inertia::ClothInertia;

/// Reports parts that cannot be used.
pub(super) fn report_inertia(
    changed: Query<(Entity, &ClothInertia), Changed<ClothInertia>>,
    mut commands: Commands,
) {
    for (entity, inertia) in &changed {
        if !inertia.is_valid() {
            ClothFailed::report(&mut commands, entity, ClothError::Inertia { entity });
        }
    }
}
