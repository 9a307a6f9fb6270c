//! The part of a shape near a cloth in a tick: of shapes that consist of many parts only the near parts are
//! queried, so that a terrain costs only the area under the cloth.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::partitioning::{Bvh, TraversalAction};
use parry3d::shape::{HeightField, Shape};

use crate::contact::collider::{Collider, SAMPLES};

/// Box around all parts of a collider that come near `cloth` in the tick, in the cloth's frame; none if no
/// part does. `cloth` is the box around all positions that the particles can reach in the tick.
pub(crate) fn swept_box(collider: &Collider, cloth: impl FnOnce() -> Option<Aabb>) -> Option<Aabb> {
    let shape = &*collider.shape.0;
    if !has_parts(shape) {
        return Some(collider.swept_box());
    }
    let poses = collider.sampled_poses();
    let all_around = |boxes: [Aabb; SAMPLES.len()], beyond: f32| {
        let sampled = boxes.iter().fold(boxes[0], |all, other| all.merged(other));
        Aabb::new(sampled.mins - beyond, sampled.maxs + beyond)
    };
    let cloth = cloth()?;
    let seen = poses.map(|pose| cloth.transform_by(&pose.inverse()));
    // In the collider's frame the cloth turns about the collider's origin, which moves along a straight line in the cloth's.
    let origins = [collider.from.0, collider.to.0];
    let way = origins[0].distance(origins[1]);
    let beyond = origins
        .map(|at| collider.beyond_samples(&Aabb::new(cloth.mins - at, cloth.maxs - at), way));
    let seen = all_around(seen, beyond[0].max(beyond[1]));
    let near = near_parts(shape, &seen)?;
    let beyond = collider.beyond_samples(&near, 0.0);
    Some(all_around(poses.map(|pose| near.transform_by(&pose)), beyond))
}

/// Whether a shape consists of parts with a spatial index.
fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_heightfield().is_some()
        || shape.as_voxels().is_some()
        || shape.as_composite_shape().is_some()
}

/// Box around all parts of a shape that intersect a box, both in the shape's frame.
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
    let mut near: Option<Aabb> = None;
    tree.traverse(|node| {
        let around = node.aabb();
        if !around.intersects(seen) {
            return TraversalAction::Prune;
        }
        // All parts within a box that is seen as a whole intersect what is seen.
        if !node.is_leaf() && !seen.contains(&around) {
            return TraversalAction::Continue;
        }
        near = Some(near.map_or(around, |near| near.merged(&around)));
        TraversalAction::Prune
    });
    near
}

/// Box of a heightfield near a box: it extends downwards without end, since a heightfield is ground.
fn near_ground(field: &HeightField, seen: &Aabb) -> Option<Aabb> {
    let mut down = *seen;
    // All cells beside or above the box are included.
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

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use parry3d::math::Pose;
    use parry3d::shape::{Ball, SharedShape, TriMesh};
    use parry3d::utils::Array2;

    use super::*;

    /// Flat ground of 200 m with a peak at a corner, so that its box reaches above the cloth.
    fn ground(cells: usize) -> SharedShape {
        let mut heights = Array2::zeros(cells + 1, cells + 1);
        heights[(0, 0)] = 50.0;
        SharedShape::new(HeightField::new(heights, Vec3::new(200.0, 1.0, 200.0)))
    }

    /// The surface of a ball of 20 m around the origin.
    fn mesh() -> SharedShape {
        let (points, triangles) = Ball::new(20.0).to_trimesh(64, 64);
        SharedShape::new(TriMesh::new(points, triangles).expect("a mesh"))
    }

    /// Two boxes, 20 m from the origin on either side.
    fn boxes() -> SharedShape {
        let boxes = [-20.0, 20.0]
            .map(|x| (Pose::translation(x, 0.0, 0.0), SharedShape::cuboid(0.5, 5.0, 0.5)));
        SharedShape::compound(boxes.to_vec())
    }

    /// The box of a fixed shape near a cloth of 2 m at a place.
    fn box_near(shape: &SharedShape, at: Vec3) -> Option<Aabb> {
        let collider = Collider::fixed(shape.clone(), Vec3::ZERO, Quat::IDENTITY);
        swept_box(&collider, || Some(Aabb::from_half_extents(at, Vec3::ONE)))
    }

    #[test]
    fn only_parts_near_a_cloth_are_queried() {
        let grounds = [16, 64, 256].map(ground);
        for (index, shape) in grounds.into_iter().chain([mesh(), boxes()]).enumerate() {
            let far = Vec3::new(0.0, 5.0, 0.0);
            assert_eq!(box_near(&shape, far), None, "shape {index}");
            let near = Vec3::new(20.0, 1.0, 0.0);
            let parts = box_near(&shape, near).expect("the cloth is at the shape");
            let width = parts.extents().x.max(parts.extents().z);
            assert!(width < 30.0, "shape {index}: {width} m");
        }
    }

    /// A compound of two rods turns by almost half a turn, and a cloth lies where its end is between two samples.
    #[test]
    fn parts_that_turn_into_a_cloth_between_samples_are_queried() {
        let ends = [-1.0, 1.0].map(|side| {
            (Pose::translation(2.0 * side, 0.0, 0.0), SharedShape::cuboid(0.01, 0.01, 0.01))
        });
        let pose = |angle: f32| (Vec3::ZERO, Quat::from_rotation_z(angle));
        let still =
            Collider::fixed(SharedShape::compound(ends.to_vec()), Vec3::ZERO, Quat::IDENTITY);
        let turn = 0.99 * core::f32::consts::PI;
        let collider = Collider { from: pose(0.0), to: pose(turn), ..still };
        for part in 0..=40 {
            let at = Quat::from_rotation_z(turn * part as f32 / 40.0) * Vec3::new(2.0, 0.0, 0.0);
            let cloth = Aabb::from_half_extents(at, Vec3::splat(0.02));
            let near = swept_box(&collider, || Some(cloth)).expect("an end passes the cloth");
            assert!(near.intersects(&cloth), "{part}: {near:?}");
        }
    }
}
