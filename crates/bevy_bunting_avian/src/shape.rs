//! From the shape of an avian collider to a collider of cloth.

use bevy_bunting::ClothCollider;
use bevy_bunting::parry3d::shape::{SharedShape, TypedShape};
use bevy_ecs::prelude::*;

use crate::error::ClothColliderError;

/// A collider of cloth with the shape of the avian collider of `entity`, in which its scale is contained.
///
/// # Errors
///
/// The shape has no surface, is not finite, or is a mesh that cannot be a collider.
pub(crate) fn collider_of(
    entity: Entity,
    shape: &SharedShape,
) -> Result<ClothCollider, ClothColliderError> {
    let bounds = shape.compute_local_aabb();
    if !(bounds.mins.is_finite() && bounds.maxs.is_finite()) {
        return Err(ClothColliderError::Size { entity });
    }
    let of_triangles = |corners, triangles| {
        ClothCollider::triangles(corners, triangles)
            .map_err(|source| ClothColliderError::Mesh { entity, source })
    };
    match shape.as_typed_shape() {
        TypedShape::TriMesh(mesh) => {
            of_triangles(mesh.vertices().to_vec(), mesh.indices().to_vec())
        }
        TypedShape::Triangle(it) => of_triangles(vec![it.a, it.b, it.c], vec![[0, 1, 2]]),
        TypedShape::Segment(_) | TypedShape::Polyline(_) | TypedShape::Custom(_) => {
            Err(ClothColliderError::Shape { entity, shape: shape.shape_type() })
        }
        _ => Ok(ClothCollider::new(shape.clone())),
    }
}
