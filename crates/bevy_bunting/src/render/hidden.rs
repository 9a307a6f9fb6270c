//! Hidden cloths are not simulated.

use bevy_camera::visibility::Visibility;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;

use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::ClothInstance;

type Looks = (&'static Visibility, Option<&'static ChildOf>);

/// Sends hidden cloths to sleep, and wakes cloths that are shown again. Visibility is looked up along the
/// hierarchy, since Bevy's `InheritedVisibility` is computed after the ticks of a frame, and not at all in an
/// app without cameras.
pub fn hide_cloths(
    mut cloths: Query<(Entity, &mut ClothInstance), With<Visibility>>,
    all: Query<Looks>,
) {
    for (entity, mut instance) in &mut cloths {
        let becomes = match (is_hidden(entity, &all), instance.activity) {
            (true, ClothActivity::Ticking | ClothActivity::AtRest | ClothActivity::OverBudget) => {
                ClothActivity::Hidden
            }
            (false, ClothActivity::Hidden) => ClothActivity::Ticking,
            _ => continue,
        };
        instance.activity = becomes;
    }
}

/// Whether an entity is hidden: by its own visibility, or by the nearest parent that does not inherit its
/// own.
fn is_hidden(mut entity: Entity, all: &Query<Looks>) -> bool {
    while let Ok((visibility, parent)) = all.get(entity) {
        match (visibility, parent) {
            (Visibility::Hidden, _) => return true,
            (Visibility::Inherited, Some(parent)) => entity = parent.parent(),
            _ => return false,
        }
    }
    false
}
