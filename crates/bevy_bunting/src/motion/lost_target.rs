//! Attachments whose target was despawned.

use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::cloth::activity::ClothPaused;
use crate::cloth::events::ClothTargetLost;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::{Attachment, TargetLost};

/// Freezes or releases cloths whose target was despawned.
pub(crate) fn handle_lost_targets(
    mut cloths: Query<(Entity, &Attachment, &mut ClothInstance)>,
    targets: Query<(), With<Transform>>,
    mut commands: Commands,
) {
    for (entity, attachment, mut instance) in &mut cloths {
        let Some(target) = attachment.target_other_than(entity) else { continue };
        if instance.target_lost || instance.target != Some(target) || targets.contains(target) {
            continue;
        }
        instance.target_lost = true;
        match attachment.on_lost {
            TargetLost::Freeze => commands.entity(entity).insert(ClothPaused),
            TargetLost::Release => commands.entity(entity).remove::<Attachment>(),
        };
        commands.trigger(ClothTargetLost { entity, target, outcome: attachment.on_lost });
    }
}
