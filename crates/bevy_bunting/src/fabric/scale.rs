//! Scales on the way to a cloth are baked into its mesh when it is made; later ones make its frame larger (`motion/growth.rs`).

use std::borrow::Cow;

use bevy_ecs::prelude::*;
use bevy_math::{Mat3, Mat3A, Quat, Vec3};
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;

/// Marks a cloth whose [`ClothMesh`] has the scale of its entity already.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct ScaleBaked;

/// To this part of itself a scale is rounded. Smaller: rounding in turned hierarchies makes cloths of one scale differ in
/// their fabrics. Larger: sizes are visibly wrong.
const STEP: f32 = 1.0 / 16_384.0;

/// Scale and shear of a cloth in its frame: of its own transform and all above it, divided by the `size` to which the cloth has grown,
/// or, if it is attached to another entity, of the attachment's offset. None remains where the mesh has its scale already, baked or by a skin.
///
/// # Errors
///
/// They are not finite, or make the cloth flat.
pub(crate) fn scale_of(
    entity: Entity,
    attachment: Option<&Attachment>,
    has_scale: bool,
    size: f32,
    transforms: &TransformHelper,
) -> Result<Mat3, ClothError> {
    if has_scale {
        return Ok(Mat3::IDENTITY);
    }
    let attached = attachment.filter(|it| it.target_other_than(entity).is_some());
    let scale = match (attached, transforms.compute_global_transform(entity)) {
        (Some(attachment), _) => Mat3::from_diagonal(attachment.offset.scale),
        (None, Ok(global)) => {
            let axes = global.affine().matrix3;
            let rotation: Quat = global.rotation();
            Mat3::from(Mat3A::from_quat(rotation.normalize()).transpose() * axes) * size.recip()
        }
        (None, Err(_)) => Mat3::IDENTITY,
    };
    let rounded = |axis: Vec3| (axis / STEP).round() * STEP;
    let scale =
        Mat3::from_cols(rounded(scale.x_axis), rounded(scale.y_axis), rounded(scale.z_axis));
    let is_good = scale.is_finite() && scale.determinant() != 0.0;
    if is_good { Ok(scale) } else { Err(ClothError::Scale { entity }) }
}

/// The mesh with a scale, in metres of the cloth's frame.
pub(crate) fn bake(mesh: &ClothMesh, scale: Mat3) -> Cow<'_, ClothMesh> {
    if scale == Mat3::IDENTITY {
        return Cow::Borrowed(mesh);
    }
    if let (&ClothMesh::Grid { columns, rows, width, height }, Some(Vec3 { x, y, .. })) =
        (mesh, along_axes(scale))
        && x > 0.0
        && y > 0.0
    {
        return Cow::Owned(ClothMesh::grid(columns, rows, width * x, height * y));
    }
    if let (&ClothMesh::Sheet { columns, rows, width, depth }, Some(Vec3 { x, y, z })) =
        (mesh, along_axes(scale))
        && x > 0.0
        && y > 0.0
        && z > 0.0
    {
        return Cow::Owned(ClothMesh::sheet(columns, rows, width * x, depth * z));
    }
    let builder = mesh.builder();
    let mut indices = builder.indices().to_vec();
    if scale.determinant() < 0.0 {
        // The front stays the front of a mirrored mesh.
        indices.as_chunks_mut::<3>().0.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    Cow::Owned(ClothMesh::Triangles {
        positions: builder.positions().iter().map(|&at| scale * at).collect(),
        indices,
        uv: mesh.uvs(),
        weights: mesh.weights().to_vec(),
        merged: builder.merged().to_vec(),
    })
}

/// The scale along each axis; none if the matrix shears.
fn along_axes(matrix: Mat3) -> Option<Vec3> {
    let scale = matrix.diagonal();
    (matrix == Mat3::from_diagonal(scale)).then_some(scale)
}
