//! Conversion of a Bevy mesh to a cloth's mesh.

use bevy_math::{Vec2, Vec3};
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};

use crate::cloth::mesh::ClothMesh;

/// Converts the triangles and texture coordinates of a mesh, in the mesh's units. A mesh that is no list of
/// triangles, or that is not kept in the main world, gives a cloth without triangles, which is reported in a
/// [`ClothFailed`](crate::ClothFailed) event.
impl From<&Mesh> for ClothMesh {
    fn from(mesh: &Mesh) -> Self {
        let positions = match mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
            Ok(VertexAttributeValues::Float32x3(positions)) => positions.as_slice(),
            _ => &[],
        };
        let uv = match mesh.try_attribute(Mesh::ATTRIBUTE_UV_0) {
            Ok(VertexAttributeValues::Float32x2(uv)) => uv.as_slice(),
            _ => &[],
        };
        let indices = match (mesh.primitive_topology(), mesh.try_indices()) {
            (PrimitiveTopology::TriangleList, Ok(Indices::U16(indices))) => {
                indices.iter().map(|&index| u32::from(index)).collect()
            }
            (PrimitiveTopology::TriangleList, Ok(Indices::U32(indices))) => indices.clone(),
            (PrimitiveTopology::TriangleList, Err(_)) => (0..positions.len() as u32).collect(),
            _ => Vec::new(),
        };
        Self::triangles(
            positions.iter().copied().map(Vec3::from).collect(),
            indices,
            uv.iter().copied().map(Vec2::from).collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use bevy_asset::RenderAssetUsages;

    use super::*;

    #[test]
    fn a_mesh_becomes_a_cloth() {
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let uv = vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]];
        let of = |topology| {
            Mesh::new(topology, RenderAssetUsages::default())
                .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners.clone())
                .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uv.clone())
        };
        for indices in [Indices::U16(vec![0, 1, 2, 1, 3, 2]), Indices::U32(vec![0, 1, 2, 1, 3, 2])]
        {
            let mesh = of(PrimitiveTopology::TriangleList).with_inserted_indices(indices);
            let cloth = ClothMesh::from(&mesh);
            let expected = ClothMesh::triangles(
                corners.iter().copied().map(Vec3::from).collect(),
                vec![0, 1, 2, 1, 3, 2],
                uv.iter().copied().map(Vec2::from).collect(),
            );
            assert_eq!(cloth, expected);
            assert_eq!(cloth.builder().check(), Ok(()));
        }
        let strip = ClothMesh::from(&of(PrimitiveTopology::TriangleStrip));
        assert!(strip.builder().build().is_err(), "told, and not guessed");
    }
}
