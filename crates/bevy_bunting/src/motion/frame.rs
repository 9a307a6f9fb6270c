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
    let (followed, offset) = match attachment {
        // Where the cloth will be is not known yet.
        Some(attachment) if attachment.brings_first => return None,
        Some(attachment) => match attachment.target_other_than(entity) {
            Some(target) => (target, attachment.offset),
            None => (entity, Transform::IDENTITY),
        },
        None => (entity, Transform::IDENTITY),
    };
    Some(frame_on(&transforms.compute_global_transform(followed).ok()?, &offset))
}

/// A target's pose times the offset. The target's scale scales the offset's translation only.
pub(crate) fn frame_on(target: &GlobalTransform, offset: &Transform) -> Isometry3d {
    let rotation = (target.rotation() * offset.rotation).normalize();
    Isometry3d::new(target.transform_point(offset.translation), rotation)
}

/// Whether all components of a frame are finite.
pub(crate) fn is_finite(frame: &Isometry3d) -> bool {
    Vec3::from(frame.translation).is_finite() && frame.rotation.is_finite()
}
