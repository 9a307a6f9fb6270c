//! The mesh that shows a level of a cloth.

use bevy_asset::RenderAssetUsages;
use bevy_math::{Vec2, Vec3};
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use bunting_solver::Fabric;

use crate::mesh::ClothMesh;

/// The mesh of a cloth at rest at its finest level: the vertices of the [`ClothMesh`].
pub fn finest(shape: &ClothMesh, fabric: &Fabric) -> Mesh {
    let mut mesh = match shape {
        ClothMesh::Grid { .. } => at_rest(fabric, fabric.triangles().as_flattened().to_vec()),
        ClothMesh::Triangles { indices, .. } => at_rest(fabric, indices.clone()),
    };
    let uvs = shape.uvs();
    if !uvs.is_empty() {
        let uvs: Vec<[f32; 2]> = uvs.iter().map(Vec2::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
    }
    mesh
}

/// The mesh of a coarser level, of some of the finest one's vertices.
pub fn coarser(finest: &Mesh, vertices: &[u32], indices: &[u32], fabric: &Fabric) -> Mesh {
    let mut mesh = at_rest(fabric, indices.to_vec());
    for (attribute, values) in finest.try_attributes().into_iter().flatten() {
        if !mesh.contains_attribute(attribute.id)
            && let Some(values) = pick(values, vertices)
        {
            mesh.insert_attribute(*attribute, values);
        }
    }
    mesh
}

/// A mesh with room for what is written each frame.
fn at_rest(fabric: &Fabric, indices: Vec<u32>) -> Mesh {
    let vertices = fabric.particle_of_vertex();
    let positions: Vec<[f32; 3]> = vertices
        .iter()
        .map(|&particle| fabric.rest_positions()[particle as usize].to_array())
        .collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Z; vertices.len()])
        .with_inserted_indices(Indices::U32(indices))
}

/// The values of some vertices, of the formats that Bevy's own attributes have.
fn pick(values: &VertexAttributeValues, vertices: &[u32]) -> Option<VertexAttributeValues> {
    use VertexAttributeValues::{Float32x2, Float32x3, Float32x4};

    match values {
        Float32x2(values) => Some(Float32x2(pick_each(values, vertices))),
        Float32x3(values) => Some(Float32x3(pick_each(values, vertices))),
        Float32x4(values) => Some(Float32x4(pick_each(values, vertices))),
        _ => None,
    }
}

fn pick_each<T: Copy>(values: &[T], vertices: &[u32]) -> Vec<T> {
    vertices.iter().map(|&vertex| values[vertex as usize]).collect()
}
