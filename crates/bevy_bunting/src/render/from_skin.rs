//! Conversion of Bevy's skinned meshes to the skins of cloths.

use bevy_asset::Assets;
use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, Mat4, Vec3};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, VertexAttributeValues};
use bevy_transform::helper::TransformHelper;

use crate::skeleton::skin::ClothSkin;

/// Bind poses of skinned meshes, if the app has such assets.
pub(super) type BindPoses<'w> = Option<Res<'w, Assets<SkinnedMeshInverseBindposes>>>;

/// The joints of a skinned mesh and their loaded bind poses.
pub(super) struct LoadedSkin<'a> {
    pub joints: &'a [Entity],
    pub inverse_bind_poses: &'a [Mat4],
}

impl<'a> LoadedSkin<'a> {
    /// The skin of an entity; none until its bind poses are loaded.
    pub fn of(skin: &'a SkinnedMesh, poses: &'a BindPoses) -> Option<Self> {
        let inverse_bind_poses = poses.as_ref()?.get(&skin.inverse_bindposes)?;
        Some(Self { joints: &skin.joints, inverse_bind_poses })
    }

    /// Scale with which the skeleton shows the mesh now, by its first joint. Bevy does not apply the mesh's own transform
    /// to skinned meshes.
    pub fn scale(&self, transforms: &TransformHelper) -> Vec3 {
        let first = self.joints.first().zip(self.inverse_bind_poses.first());
        let matrix = first.and_then(|(&joint, pose)| {
            let global = transforms.compute_global_transform(joint).ok()?;
            Some(global.affine() * Affine3A::from_mat4(*pose))
        });
        matrix.map_or(Vec3::ONE, |matrix| matrix.to_scale_rotation_translation().0)
    }

    /// The skin of a cloth with the vertices of a mesh into which a scale is baked. A mesh without joint attributes gives a
    /// skin without vertices, which is reported later.
    pub fn convert(&self, mesh: &Mesh, scale: Vec3) -> ClothSkin {
        let unscaled = Mat4::from_scale(scale.recip());
        let poses = self.inverse_bind_poses.iter().map(|pose| *pose * unscaled);
        let skin = ClothSkin::new(self.joints.iter().copied().zip(poses));
        match (
            mesh.try_attribute(Mesh::ATTRIBUTE_JOINT_INDEX),
            mesh.try_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT),
        ) {
            (
                Ok(VertexAttributeValues::Uint16x4(indices)),
                Ok(VertexAttributeValues::Float32x4(weights)),
            ) => skin.with_vertices(indices.iter().copied().zip(weights.iter().copied())),
            _ => skin,
        }
    }
}

/// Takes the joints out of a mesh that is shown where the simulation puts it.
pub(super) fn unbind(mesh: &mut Mesh) {
    for attribute in [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT] {
        mesh.remove_attribute(attribute);
    }
}
