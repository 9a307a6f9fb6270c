//! The point of a shape's surface that is nearest to a point.

use glam::Vec3;
use parry3d::query::PointProjection;
use parry3d::shape::Shape;

/// The point of a shape's surface nearest to `at`, and whether `at` is inside, both in the shape's frame. For meshes of
/// triangles, parry tells inside from outside only together with the feature: by the pseudo-normals of an oriented mesh
/// (Bærentzen and Aanæs 2005). Other meshes have no inside.
pub(super) fn nearest_point(shape: &dyn Shape, at: Vec3) -> PointProjection {
    match shape.as_trimesh() {
        Some(mesh) if mesh.pseudo_normals().is_some() => {
            shape.project_local_point_and_get_feature(at).0
        }
        _ => shape.project_local_point(at, false),
    }
}
