//! Tangents of meshes, along growing u, for normal maps.

use bevy_math::{Vec2, Vec3, Vec4};
use bevy_mesh::{Mesh, VertexAttributeValues};

/// Sums of tangents, one for each vertex; the memory is reused from frame to frame.
#[derive(Debug, Default)]
pub struct TangentSums {
    sums: Vec<Vec3>,
}

impl TangentSums {
    /// Computes the tangents of a mesh that has tangents, from its positions, normals and texture
    /// coordinates. The sign of the bitangent does not depend on the shape and is kept.
    pub fn write_tangents(&mut self, mesh: &mut Mesh) {
        if mesh.contains_attribute(Mesh::ATTRIBUTE_TANGENT) && self.add_up(mesh).is_some() {
            self.write_sums(mesh);
        }
    }

    /// Adds to each corner of a triangle the triangle's tangent, weighted by its area in the texture.
    fn add_up(&mut self, mesh: &Mesh) -> Option<()> {
        use VertexAttributeValues::{Float32x2, Float32x3};

        let Float32x3(positions) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)? else { return None };
        let Float32x2(uvs) = mesh.attribute(Mesh::ATTRIBUTE_UV_0)? else { return None };
        self.sums.clear();
        self.sums.resize(positions.len(), Vec3::ZERO);
        let mut indices = mesh.indices()?.iter();
        while let (Some(a), Some(b), Some(c)) = (indices.next(), indices.next(), indices.next()) {
            let position = |vertex: usize| Vec3::from(positions[vertex]);
            let uv = |vertex: usize| Vec2::from(uvs[vertex]);
            let (ab, ac) = (position(b) - position(a), position(c) - position(a));
            let (along_ab, along_ac) = (uv(b) - uv(a), uv(c) - uv(a));
            let along_u =
                (ab * along_ac.y - ac * along_ab.y) * along_ab.perp_dot(along_ac).signum();
            for vertex in [a, b, c] {
                self.sums[vertex] += along_u;
            }
        }
        Some(())
    }

    /// Writes the sums, made perpendicular to the normals and of unit length.
    fn write_sums(&self, mesh: &mut Mesh) {
        use VertexAttributeValues::{Float32x3, Float32x4};

        let (mut normals, mut tangents) = (None, None);
        for (attribute, values) in mesh.attributes_mut() {
            match values {
                Float32x3(values) if attribute.id == Mesh::ATTRIBUTE_NORMAL.id => {
                    normals = Some(values);
                }
                Float32x4(values) if attribute.id == Mesh::ATTRIBUTE_TANGENT.id => {
                    tangents = Some(values);
                }
                _ => {}
            }
        }
        let (Some(normals), Some(tangents)) = (normals, tangents) else { return };
        for ((tangent, normal), sum) in tangents.iter_mut().zip(normals).zip(&self.sums) {
            let [.., side] = *tangent;
            let across = sum.reject_from_normalized(Vec3::from(*normal));
            *tangent = Vec4::from((across.normalize_or_zero(), side)).to_array();
        }
    }
}
