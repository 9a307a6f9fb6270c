//! Takes scales out of the propagated transforms of cloths.

use bevy_ecs::hierarchy::Children;
use bevy_ecs::prelude::*;
use bevy_math::Mat3A;
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;
use crate::motion::frame::{frame_and_scale_of, is_finite};
use crate::motion::place::sized;

/// Greatest error of the dot products of a frame's axes compared with those of orthogonal unit vectors.
/// Smaller: rounding counts as a scale. Larger: a scale is shown.
const ORTHONORMAL_TOLERANCE: f32 = 1e-4;

type Propagated<'w, 's> = Query<
    'w,
    's,
    (Entity, Option<&'static Attachment>, &'static ClothInstance, &'static GlobalTransform),
    (With<ClothMesh>, Changed<GlobalTransform>),
>;

type Hierarchy<'w, 's> =
    Query<'w, 's, (&'static Transform, Option<&'static Children>, &'static mut GlobalTransform)>;

/// Removes the scales of parents, targets and cloths from the propagated transforms of cloths: a frame has no
/// scale but that by which the cloth has grown, and a local transform cannot undo a scale along rotated axes. The children of these cloths are
/// corrected with them.
pub(super) fn remove_scales(
    mut transforms: ParamSet<((TransformHelper, Propagated), Hierarchy)>,
    mut changed: Local<Vec<(Entity, GlobalTransform)>>,
) {
    let (current, cloths) = transforms.p0();
    changed.extend(cloths.iter().filter_map(|(entity, attachment, instance, propagated)| {
        let axes = propagated.affine().matrix3;
        let products = axes.transpose() * axes;
        if products.abs_diff_eq(Mat3A::IDENTITY, ORTHONORMAL_TOLERANCE) {
            return None;
        }
        let (frame, scale) = frame_and_scale_of(entity, attachment, &current)?;
        is_finite(&frame).then(|| (entity, sized(frame, instance.growth.present(scale))))
    }));
    let mut hierarchy = transforms.p1();
    while let Some((entity, global)) = changed.pop() {
        let Ok((_, children, mut written)) = hierarchy.get_mut(entity) else { continue };
        *written = global;
        let children: Vec<Entity> = children.into_iter().flat_map(|all| all.iter()).collect();
        for child in children {
            if let Ok((local, ..)) = hierarchy.get(child) {
                changed.push((child, global * *local));
            }
        }
    }
}
