//! The frame of a cloth: the pose of its attachment's target times the offset, or the cloth's own pose.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

use crate::motion::attachment::Attachment;

/// The current frame of a cloth, or the current pose of a collider. None if the target is despawned, or a
/// vertex is to be brought to it.
pub(crate) fn frame_of(
    entity: Entity,
    attachment: Option<&Attachment>,
    transforms: &TransformHelper,
) -> Option<Isometry3d> {
    frame_and_scale_of(entity, attachment, transforms).map(|(frame, _)| frame)
}

/// The frame as [`frame_of`], and the scale in the world of what it follows.
pub(crate) fn frame_and_scale_of(
    entity: Entity,
    attachment: Option<&Attachment>,
    transforms: &TransformHelper,
) -> Option<(Isometry3d, Vec3)> {
    let (followed, offset) = match attachment {
        // Where the cloth will be is not known yet.
        Some(attachment) if attachment.brings_first => return None,
        Some(attachment) => match attachment.target_other_than(entity) {
            Some(target) => (target, attachment.offset),
            None => (entity, Transform::IDENTITY),
        },
        None => (entity, Transform::IDENTITY),
    };
    Some(frame_and_scale_on(&transforms.compute_global_transform(followed).ok()?, &offset))
}

/// Scale in the world of what the frame of a cloth follows; none if it is not there.
pub(crate) fn followed_scale(
    entity: Entity,
    attachment: Option<&Attachment>,
    transforms: &TransformHelper,
) -> Option<Vec3> {
    let target = attachment.and_then(|attachment| attachment.target_other_than(entity));
    let followed = transforms.compute_global_transform(target.unwrap_or(entity));
    followed.ok().map(|followed| followed.scale())
}

/// A target's pose times the offset. The target's scale scales the offset's translation only.
pub(crate) fn frame_on(target: &GlobalTransform, offset: &Transform) -> Isometry3d {
    frame_and_scale_on(target, offset).0
}

/// The frame as [`frame_on`], and the scale of the target.
fn frame_and_scale_on(target: &GlobalTransform, offset: &Transform) -> (Isometry3d, Vec3) {
    let (scale, rotation, _) = target.to_scale_rotation_translation();
    let rotation = (rotation * offset.rotation).normalize();
    (Isometry3d::new(target.transform_point(offset.translation), rotation), scale)
}

/// Whether all components of a frame are finite.
pub(crate) fn is_finite(frame: &Isometry3d) -> bool {
    Vec3::from(frame.translation).is_finite() && frame.rotation.is_finite()
}
