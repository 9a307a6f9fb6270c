//! Cloths that are held by springs and rails, or whose anchors may break, get the components that this needs.

use bevy_ecs::prelude::*;

use crate::anchors::grab::{ClothGrab, Grabbed};
use crate::anchors::holds::ClothHolds;
use crate::anchors::reactions::AnchorReactions;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::mesh::ClothMesh;
use crate::lod::sleep::WakeCloth;
use crate::motion::attachment::Attachment;
use crate::motion::pose::PoseHistory;

/// Gives cloths with springs or rails [`ClothHolds`], and those with anchors that may break [`AnchorReactions`]. Reports
/// anchors that cannot be used.
pub(super) fn follow_holds(
    attachments: Query<(Entity, &Attachment), Changed<Attachment>>,
    mut commands: Commands,
) {
    for (entity, attachment) in &attachments {
        let anchors = &attachment.anchors;
        if anchors.iter().any(|anchor| !anchor.hold.is_rigid()) {
            commands.entity(entity).insert_if_new(ClothHolds::default());
        }
        if anchors.iter().any(|anchor| anchor.break_force < f32::INFINITY) {
            commands.entity(entity).insert_if_new(AnchorReactions::default());
        }
        for (anchor, its) in anchors.iter().enumerate() {
            if !its.is_valid() {
                let error = ClothError::Anchor { entity, anchor };
                ClothFailed::report(&mut commands, entity, error);
            }
        }
    }
}

/// Gives cloths that are grabbed [`ClothHolds`], and wakes them. Reports grabs that cannot be used.
pub(super) fn follow_grabs(
    mut grabs: Query<(Entity, Ref<ClothGrab>, &mut Grabbed, &PoseHistory)>,
    cloths: Query<Has<ClothHolds>, With<ClothMesh>>,
    mut commands: Commands,
) {
    for (hand, grab, mut grabbed, history) in &mut grabs {
        let entity = grab.cloth;
        let has_holds = cloths.get(entity).ok().filter(|_| grab.is_valid());
        if history.has_new(&grab) {
            *grabbed = Grabbed::default();
            match has_holds {
                Some(_) => commands.trigger(WakeCloth { entity }),
                None => {
                    let error = ClothError::Grab { entity, hand };
                    ClothFailed::report(&mut commands, entity, error);
                }
            }
        }
        if has_holds == Some(false) {
            commands.entity(entity).insert(ClothHolds::default());
        }
    }
}

/// Forgets what was grabbed when a hand lets go.
pub(super) fn let_go(removed: On<Remove, ClothGrab>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<Grabbed>();
}
