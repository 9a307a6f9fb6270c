//! Attachments whose targets were despawned.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use crate::cloth::activity::ClothPaused;
use crate::cloth::events::ClothTargetLost;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::{Attachment, TargetLost};

type AttachedCloth = (
    Entity,
    &'static mut Attachment,
    &'static mut ClothInstance,
    &'static mut Transform,
    Has<ClothPaused>,
);

/// Freezes cloths of which a target was despawned, or releases the vertices on it.
pub(crate) fn handle_lost_targets(
    mut cloths: Query<AttachedCloth>,
    targets: Query<(), With<Transform>>,
    mut commands: Commands,
) {
    for (entity, mut attachment, mut instance, mut transform, is_paused) in &mut cloths {
        if instance.target_lost || instance.levels.is_none() {
            continue;
        }
        let target = attachment.target_other_than(entity);
        let own = target.filter(|&target| instance.target == Some(target));
        let followed = own.into_iter().map(|target| (target, attachment.on_lost));
        let anchors = attachment.anchors.iter().map(|it| (it.target, attachment.outcome_of(it)));
        let lost = followed.chain(anchors).filter(|it| !targets.contains(it.0));
        let (mut lost, outcomes): (Vec<Entity>, Vec<TargetLost>) = lost.unzip();
        if lost.is_empty() {
            continue;
        }
        lost.sort_unstable();
        lost.dedup();
        // What is frozen lets go nothing.
        let freezes = outcomes.contains(&TargetLost::Freeze);
        let outcome = if freezes { TargetLost::Freeze } else { TargetLost::Release };
        match outcome {
            TargetLost::Freeze => {
                instance.target_lost = true;
                instance.frozen = !is_paused;
                commands.entity(entity).insert(ClothPaused);
            }
            TargetLost::Release => {
                let loses_own = own.is_some_and(|own| lost.contains(&own));
                if loses_own && attachment.offset.scale != Vec3::ONE {
                    // The scale of the offset is that of the cloth, which keeps its size.
                    transform.scale *= attachment.offset.scale;
                }
                if !attachment.release(&lost) {
                    instance.target_lost = true;
                    commands.entity(entity).remove::<Attachment>();
                }
            }
        }
        for target in lost {
            commands.trigger(ClothTargetLost { entity, target, outcome });
        }
    }
}
