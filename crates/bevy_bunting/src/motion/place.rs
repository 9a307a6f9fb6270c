//! Writes the transforms of attached cloths.

use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;
use crate::motion::follow::MovedEntities;
use crate::motion::frame::{frame_of, frame_on, is_finite};

type PlacedCloth = (Option<&'static Attachment>, Option<&'static ChildOf>);

type Transforms<'w, 's> = Query<'w, 's, (&'static mut Transform, &'static mut GlobalTransform)>;

/// A cloth's transforms: the local one only of attached cloths.
type Placement = (Entity, Option<Transform>, GlobalTransform);

/// Writes the transforms of cloths that may have moved. A cloth's frame follows from the current pose of its
/// target, which may be newer than the pose in the last tick.
pub(crate) fn place_cloths(
    cloths: Query<PlacedCloth, With<ClothMesh>>,
    new: Query<Entity, Added<ClothMesh>>,
    mut transforms: ParamSet<((TransformHelper, MovedEntities), Transforms)>,
    mut placements: Local<Vec<Placement>>,
) {
    let (current, mut moved) = transforms.p0();
    placements.clear();
    placements.extend(moved.find(new).iter().filter_map(|&entity| {
        let (attachment, parent) = cloths.get(entity).ok()?;
        if attachment.is_some_and(|it| it.brings_first) {
            return None;
        }
        let target = attachment.and_then(|it| Some((it, it.target_other_than(entity)?)));
        match target {
            Some((attachment, target)) => {
                let parent = parent.map(ChildOf::parent);
                placement_on(target, &attachment.offset, parent, &current)
                    .map(|(local, global)| (entity, Some(local), global))
            }
            None => {
                let frame = frame_of(entity, None, &current).filter(is_finite)?;
                Some((entity, None, GlobalTransform::from_isometry(frame)))
            }
        }
    }));
    let mut written = transforms.p1();
    for (entity, local, global) in placements.drain(..) {
        if let Ok((mut transform, mut global_transform)) = written.get_mut(entity) {
            if let Some(local) = local {
                transform.set_if_neq(local);
            }
            global_transform.set_if_neq(global);
        }
    }
}

/// The transforms of a cloth at an offset from its target, local to its parent and global. None if the
/// target or the parent is despawned, or a transform is not finite.
fn placement_on(
    target: Entity,
    offset: &Transform,
    parent: Option<Entity>,
    current: &TransformHelper,
) -> Option<(Transform, GlobalTransform)> {
    let target_pose = current.compute_global_transform(target).ok()?;
    let frame = frame_on(&target_pose, offset);
    let global = GlobalTransform::from_isometry(frame);
    let local = match parent {
        // The offset itself has no rounding error of the target's pose.
        Some(parent) if parent == target => {
            Transform { scale: target_pose.scale().recip(), ..*offset }
        }
        Some(parent) => global.reparented_to(&current.compute_global_transform(parent).ok()?),
        None => Transform::from_isometry(frame),
    };
    (local.is_finite() && global.affine().is_finite()).then_some((local, global))
}
