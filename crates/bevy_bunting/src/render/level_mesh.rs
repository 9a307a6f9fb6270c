//! The mesh that shows a level of a cloth: what the level simulates, and all that is rigid.

use bevy_asset::RenderAssetUsages;
use bevy_math::{Vec2, Vec3};
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};

use crate::cloth::mesh::ClothMesh;
use crate::fabric::levels::ClothLevels;
use crate::fabric::part::RigidPart;

/// What the mesh of a level consists of.
#[derive(Clone, Debug)]
pub(crate) struct LevelMesh {
    /// The vertices of the [`ClothMesh`] that it has, ascending.
    vertices: Vec<u32>,
    /// Three of these a triangle.
    indices: Vec<u32>,
    /// Where in it the vertices are that the level simulates, in the order of its fabric.
    pub simulated: Vec<u32>,
    /// Where in it the rigid vertices are.
    rigid: Vec<u32>,
}

impl LevelMesh {
    /// Of a level that simulates some vertices, three of them a triangle, beside the rigid part.
    pub fn new(simulated: &[u32], indices: &[u32], part: &RigidPart) -> Self {
        let rigid = || part.vertices.iter().map(|rest| rest.vertex);
        let mut vertices: Vec<u32> = simulated.iter().copied().chain(rigid()).collect();
        vertices.sort_unstable();
        let place = |vertex: u32| vertices.binary_search(&vertex).ok().map(|at| at as u32);
        let moving = indices.as_chunks::<3>().0.iter();
        let moving = moving.map(|corners| corners.map(|corner| simulated[corner as usize]));
        // A level keeps all that is pinned, and so the corners of rigid triangles.
        let triangles = moving.chain(part.triangles.iter().copied()).filter_map(|corners| {
            let [a, b, c] = corners.map(place);
            Some([a?, b?, c?])
        });
        Self {
            indices: triangles.flatten().collect(),
            simulated: simulated.iter().copied().filter_map(place).collect(),
            rigid: rigid().filter_map(place).collect(),
            vertices,
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }
}

/// The mesh of a cloth at rest at its finest level: the vertices of the [`ClothMesh`].
pub fn finest(shape: &ClothMesh, levels: &ClothLevels) -> Mesh {
    let mut mesh = at_rest(levels, 0);
    let uvs = shape.uvs();
    if !uvs.is_empty() {
        let uvs: Vec<[f32; 2]> = uvs.iter().map(Vec2::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
    }
    mesh
}

/// The mesh of a coarser level, of some of the finest one's vertices.
pub fn coarser(finest: &Mesh, levels: &ClothLevels, level: usize) -> Mesh {
    let mut mesh = at_rest(levels, level);
    for (attribute, values) in finest.try_attributes().into_iter().flatten() {
        if !mesh.contains_attribute(attribute.id)
            && let Some(values) = pick(values, &levels.mesh(level).vertices)
        {
            mesh.insert_attribute(*attribute, values);
        }
    }
    mesh
}

/// A mesh with room for what is written each frame.
fn at_rest(levels: &ClothLevels, level: usize) -> Mesh {
    let (fabric, parts) = (levels.fabric(level), levels.mesh(level));
    let mut positions = vec![[0.0; 3]; parts.vertex_count()];
    for (&place, &particle) in parts.simulated.iter().zip(fabric.particle_of_vertex()) {
        positions[place as usize] = fabric.rest_positions()[particle as usize].to_array();
    }
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Z; parts.vertex_count()])
        .with_inserted_indices(Indices::U32(parts.indices.clone()));
    write_rigid(&mut mesh, levels, level);
    mesh
}

/// Writes what is rigid into the mesh of a level, once and for all.
pub fn write_rigid(mesh: &mut Mesh, levels: &ClothLevels, level: usize) {
    let rigid = &levels.rigid().vertices;
    for (attribute, values) in [
        (Mesh::ATTRIBUTE_POSITION, rigid.iter().map(|rest| rest.position).collect::<Vec<_>>()),
        (Mesh::ATTRIBUTE_NORMAL, rigid.iter().map(|rest| rest.normal).collect()),
    ] {
        if let Ok(VertexAttributeValues::Float32x3(written)) = mesh.try_attribute_mut(attribute) {
            for (&place, value) in levels.mesh(level).rigid.iter().zip(values) {
                written[place as usize] = value.to_array();
            }
        }
    }
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
