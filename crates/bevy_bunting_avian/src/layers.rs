//! Avian's collision layers, for colliders and for cloths.

use avian3d::prelude::CollisionLayers;
use bevy_bunting::{ClothLayers, ClothMesh};
use bevy_ecs::prelude::*;

use crate::colliders::FromAvian;

/// Filter of cloths, and of colliders that cloth may touch.
type TouchesCloth = Or<(With<ClothMesh>, With<FromAvian>)>;

/// Keeps the layers of cloths, and of colliders that cloth may touch, those of avian.
pub(crate) fn copy_layers(
    mut entities: Query<(Entity, &CollisionLayers, Option<&mut ClothLayers>), TouchesCloth>,
    mut commands: Commands,
) {
    for (entity, layers, cloth_layers) in &mut entities {
        let layers = ClothLayers::new(layers.memberships.0, layers.filters.0);
        match cloth_layers {
            Some(mut known) => {
                known.set_if_neq(layers);
            }
            None => {
                commands.entity(entity).insert(layers);
            }
        }
    }
}
