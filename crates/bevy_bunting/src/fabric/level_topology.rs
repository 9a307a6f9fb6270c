//! The topology of the mesh that shows a level of a cloth: the simulated part at this level and the
//! whole rigid part.

use crate::fabric::rigid::RigidPart;

/// Vertices and triangles of the mesh that shows a level.
#[derive(Clone, Debug)]
pub(crate) struct LevelTopology {
    /// The mesh's vertices as indices in the [`ClothMesh`](crate::ClothMesh), ascending.
    pub vertices: Vec<u32>,
    /// Three vertices a triangle, as indices in the mesh.
    pub indices: Vec<u32>,
    /// Indices in the mesh of the simulated vertices, in the order of the level's fabric.
    pub simulated: Vec<u32>,
    /// Indices in the mesh of the rigid vertices, in the order of the [`RigidPart`].
    pub rigid: Vec<u32>,
}

impl LevelTopology {
    /// The mesh of a level that simulates some vertices of the [`ClothMesh`](crate::ClothMesh), with
    /// triangles as indices into these vertices, together with the rigid part.
    pub fn new(simulated: &[u32], indices: &[u32], part: &RigidPart) -> Self {
        let rigid = || part.vertices.iter().map(|rest| rest.vertex);
        let mut vertices: Vec<u32> = simulated.iter().copied().chain(rigid()).collect();
        vertices.sort_unstable();
        let index = |vertex: u32| vertices.binary_search(&vertex).ok().map(|index| index as u32);
        let moving = indices.as_chunks::<3>().0.iter();
        let moving = moving.map(|corners| corners.map(|corner| simulated[corner as usize]));
        // A level keeps all pinned vertices, and so all corners that rigid triangles share with simulated
        // ones.
        let triangles = moving.chain(part.triangles.iter().copied()).filter_map(|corners| {
            let [a, b, c] = corners.map(index);
            Some([a?, b?, c?])
        });
        Self {
            indices: triangles.flatten().collect(),
            simulated: simulated.iter().copied().filter_map(index).collect(),
            rigid: rigid().filter_map(index).collect(),
            vertices,
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }
}
