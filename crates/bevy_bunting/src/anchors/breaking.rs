//! Anchors that break.

use bevy_ecs::prelude::*;

use crate::anchors::reactions::AnchorReactions;
use crate::cloth::events::ClothAnchorBroke;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::Attachment;

/// Removes anchors on which cloths pulled too hard in the tick before, and triggers events.
pub(super) fn break_anchors(
    mut cloths: Query<(Entity, &mut Attachment, &AnchorReactions, &ClothInstance)>,
    mut commands: Commands,
) {
    for (entity, mut attachment, reactions, instance) in &mut cloths {
        if instance.lane().is_none() || reactions.anchors.len() != attachment.anchors.len() {
            continue;
        }
        let pulls = attachment.anchors.iter().zip(&reactions.anchors);
        let broken = (0..).zip(pulls).filter(|(_, (anchor, pull))| {
            anchor.is_valid() && pull.force.length() > anchor.break_force
        });
        let events = broken.map(|(index, (anchor, pull))| {
            let (target, force) = (anchor.target, pull.force);
            ClothAnchorBroke { entity, target, anchor: index, force }
        });
        let events: Vec<ClothAnchorBroke> = events.collect();
        for event in events.iter().rev() {
            attachment.anchors.remove(event.anchor);
        }
        events.into_iter().for_each(|event| commands.trigger(event));
    }
}
