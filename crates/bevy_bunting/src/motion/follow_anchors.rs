//! Cloths get and lose the components that their anchors need.

use bevy_ecs::prelude::*;

use crate::motion::anchor_pins::AnchorPins;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;

/// Gives cloths with anchors [`AnchorPoses`] and [`AnchorPins`].
pub(super) fn follow_anchors(
    attachments: Query<(Entity, &Attachment, Has<AnchorPoses>), Changed<Attachment>>,
    mut commands: Commands,
) {
    for (entity, attachment, has_poses) in &attachments {
        let has_anchors = !attachment.anchors.is_empty();
        if has_anchors && !has_poses {
            commands.entity(entity).insert((AnchorPoses::default(), AnchorPins::default()));
        } else if has_poses && !has_anchors {
            commands.entity(entity).remove::<(AnchorPoses, AnchorPins)>();
        }
    }
}
