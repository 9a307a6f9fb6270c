//! Makes the mesh that shows a level of a cloth: the simulated part at this level and the rigid part.

use bevy_asset::RenderAssetUsages;
use bevy_math::{Vec2, Vec3};
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};

use crate::cloth::mesh::ClothMesh;
use crate::fabric::levels::ClothLevels;

/// Makes the mesh of the finest level at rest, with the vertices of the [`ClothMesh`].
pub fn finest(shape: &ClothMesh, levels: &ClothLevels) -> Mesh {
    let mut mesh = at_rest(levels, 0);
    let uvs = shape.uvs();
    if !uvs.is_empty() {
        let uvs: Vec<[f32; 2]> = uvs.iter().map(Vec2::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
    }
    mesh
}

/// Makes the mesh of a coarser level at rest. Attributes besides positions and normals are copied from the
/// same vertices of the finest mesh.
pub fn coarser(finest: &Mesh, levels: &ClothLevels, level: usize) -> Mesh {
    let mut mesh = at_rest(levels, level);
    let picked = with_vertices(finest.clone(), levels.topology(level).vertices.clone());
    for (attribute, values) in picked.attributes() {
        if !mesh.contains_attribute(attribute.id) {
            mesh.insert_attribute(*attribute, values.clone());
        }
    }
    mesh
}

/// Makes the mesh of a level at rest, with positions, normals and triangles. Normals of simulated vertices
/// are written with the first surface.
fn at_rest(levels: &ClothLevels, level: usize) -> Mesh {
    let topology = levels.topology(level);
    let drawn = levels.drawn(level, levels.fabric(level).rest_positions());
    let mut positions = vec![[0.0; 3]; topology.vertex_count()];
    for (&vertex, &point) in topology.simulated.iter().zip(drawn.point_of_vertex) {
        positions[vertex as usize] = drawn.positions[point as usize].to_array();
    }
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Z; topology.vertex_count()])
        .with_inserted_indices(Indices::U32(topology.indices.clone()));
    write_rigid(&mut mesh, levels, level);
    mesh
}

/// Writes the rigid vertices into the mesh of a level.
pub fn write_rigid(mesh: &mut Mesh, levels: &ClothLevels, level: usize) {
    let rigid = &levels.rigid().vertices;
    for (attribute, values) in [
        (Mesh::ATTRIBUTE_POSITION, rigid.iter().map(|rest| rest.position).collect::<Vec<_>>()),
        (Mesh::ATTRIBUTE_NORMAL, rigid.iter().map(|rest| rest.normal).collect()),
    ] {
        if let Ok(VertexAttributeValues::Float32x3(written)) = mesh.try_attribute_mut(attribute) {
            for (&vertex, value) in levels.topology(level).rigid.iter().zip(values) {
                written[vertex as usize] = value.to_array();
            }
        }
    }
}

/// The mesh with some of its vertices, which may be repeated, and without triangles. Attributes of every format are
/// picked.
pub fn with_vertices(mesh: Mesh, vertices: Vec<u32>) -> Mesh {
    mesh.with_inserted_indices(Indices::U32(vertices)).with_duplicated_vertices()
}
