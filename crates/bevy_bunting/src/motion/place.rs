//! Writes the transforms of attached cloths.

use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;
use crate::motion::follow::MovedEntities;
use crate::motion::frame::{frame_and_scale_of, frame_on, is_finite};
use crate::motion::growth::Growth;

type PlacedCloth = (Option<&'static Attachment>, Option<&'static ChildOf>, &'static ClothInstance);

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
        let (attachment, parent, instance) = cloths.get(entity).ok()?;
        let growth = &instance.growth;
        if attachment.is_some_and(|it| it.brings_first) {
            return None;
        }
        let target = attachment.and_then(|it| Some((it, it.target_other_than(entity)?)));
        match target {
            Some((attachment, target)) => {
                let parent = parent.map(ChildOf::parent);
                placement_on(target, &attachment.offset, growth, parent, &current)
                    .map(|(local, global)| (entity, Some(local), global))
            }
            None => {
                let (frame, scale) = frame_and_scale_of(entity, None, &current)?;
                is_finite(&frame).then(|| (entity, None, sized(frame, growth.present(scale))))
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

/// The transform of a cloth's frame, whose units are metres times a size.
pub(super) fn sized(frame: Isometry3d, size: f32) -> GlobalTransform {
    if size == 1.0 {
        return GlobalTransform::from_isometry(frame);
    }
    Transform::from_isometry(frame).with_scale(Vec3::splat(size)).into()
}

/// The transforms of a cloth at an offset from its target, local to its parent and global. None if the
/// target or the parent is despawned, or a transform is not finite.
fn placement_on(
    target: Entity,
    offset: &Transform,
    growth: &Growth,
    parent: Option<Entity>,
    current: &TransformHelper,
) -> Option<(Transform, GlobalTransform)> {
    let target_pose = current.compute_global_transform(target).ok()?;
    let frame = frame_on(&target_pose, offset);
    let size = growth.present(target_pose.scale());
    let global = sized(frame, size);
    let local = match parent {
        // The offset itself has no rounding error of the target's pose.
        Some(parent) if parent == target => {
            Transform { scale: size * target_pose.scale().recip(), ..*offset }
        }
        Some(parent) => global.reparented_to(&current.compute_global_transform(parent).ok()?),
        None => Transform::from_isometry(frame).with_scale(Vec3::splat(size)),
    };
    (local.is_finite() && global.affine().is_finite()).then_some((local, global))
}
