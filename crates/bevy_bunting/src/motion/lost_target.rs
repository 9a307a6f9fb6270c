//! Attachments whose targets were despawned.

use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::cloth::activity::ClothPaused;
use crate::cloth::events::ClothTargetLost;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::{Attachment, TargetLost};

/// Freezes or releases cloths whose target was despawned, or the vertices of a despawned anchor.
pub(crate) fn handle_lost_targets(
    mut cloths: Query<(Entity, &mut Attachment, &mut ClothInstance, Has<ClothPaused>)>,
    targets: Query<(), With<Transform>>,
    mut commands: Commands,
) {
    for (entity, mut attachment, mut instance, is_paused) in &mut cloths {
        if instance.target_lost {
            continue;
        }
        let target = attachment.target_other_than(entity);
        let own = target.filter(|&target| instance.target == Some(target));
        let mut followed = own.into_iter().chain(attachment.anchors.iter().map(|it| it.target));
        let is_cut = instance.levels.is_some();
        let Some(lost) = followed.find(|&target| is_cut && !targets.contains(target)) else {
            continue;
        };
        let outcome = attachment.on_lost;
        match outcome {
            TargetLost::Freeze => {
                instance.target_lost = true;
                instance.frozen = !is_paused;
                commands.entity(entity).insert(ClothPaused);
            }
            TargetLost::Release if own == Some(lost) => {
                instance.target_lost = true;
                commands.entity(entity).remove::<Attachment>();
            }
            TargetLost::Release => attachment.anchors.retain(|anchor| anchor.target != lost),
        }
        commands.trigger(ClothTargetLost { entity, target: lost, outcome });
    }
}
