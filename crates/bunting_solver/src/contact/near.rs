//! Which part of a shape is near a cloth in a tick: shapes that consist of many parts are asked for those
//! alone, so that a terrain costs what lies under the cloth.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::partitioning::Bvh;
use parry3d::shape::{HeightField, Shape};

use crate::contact::collider::Collider;

/// Parts of the tick at which the box around a moving collider is taken.
const SAMPLES: [f32; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The box around all of a collider that comes near `cloth` in the tick, in the cloth's frame; none where
/// nothing does. `cloth` is the box around all that the particles reach in the tick.
pub(crate) fn swept_box(collider: &Collider, cloth: impl FnOnce() -> Option<Aabb>) -> Option<Aabb> {
    let shape = &*collider.shape.0;
    let poses = SAMPLES.map(|part| collider.pose_at(part));
    let swept = |local: Aabb| {
        let boxes = poses.iter().map(|pose| local.transform_by(pose));
        boxes.reduce(|one, other| one.merged(&other))
    };
    if !has_parts(shape) {
        let boxes = poses.iter().map(|pose| shape.compute_aabb(pose));
        return boxes.reduce(|one, other| one.merged(&other));
    }
    let cloth = cloth()?;
    let seen = poses.iter().map(|pose| cloth.transform_by(&pose.inverse()));
    let seen = seen.reduce(|one, other| one.merged(&other))?;
    near_parts(shape, &seen).and_then(swept)
}

/// Whether a shape consists of parts that are found by where they are.
fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_heightfield().is_some()
        || shape.as_voxels().is_some()
        || shape.as_composite_shape().is_some()
}

/// The box around all parts of a shape that a box meets, both in the shape's frame.
fn near_parts(shape: &dyn Shape, seen: &Aabb) -> Option<Aabb> {
    if let Some(field) = shape.as_heightfield() {
        return near_ground(field, seen);
    }
    if let Some(voxels) = shape.as_voxels() {
        let half = 0.5 * voxels.voxel_size();
        let near = voxels.voxels_intersecting_local_aabb(seen).map(|voxel| voxel.center);
        let boxes = near.map(|centre| Aabb::new(centre - half, centre + half));
        return boxes.reduce(|one, other| one.merged(&other));
    }
    near_leaves(shape.as_composite_shape()?.bvh(), seen)
}

fn near_leaves(tree: &Bvh, seen: &Aabb) -> Option<Aabb> {
    let leaves = tree.intersect_aabb(seen).filter_map(|leaf| tree.leaf_node(leaf));
    leaves.map(|leaf| leaf.aabb()).reduce(|one, other| one.merged(&other))
}

/// A heightfield is ground: what it is above reaches down without end.
fn near_ground(field: &HeightField, seen: &Aabb) -> Option<Aabb> {
    let mut down = *seen;
    // All cells beside or above the box.
    down.maxs.y = down.maxs.y.max(field.root_aabb().maxs.y);
    let mut near: Option<Aabb> = None;
    field.map_elements_in_local_aabb(&down, &mut |_, triangle| {
        let around = triangle.local_aabb();
        near = Some(near.map_or(around, |near| near.merged(&around)));
    });
    let mut near = near?;
    near.mins.y = near.mins.y.min(seen.mins.y);
    near.intersects(seen).then_some(near)
}
