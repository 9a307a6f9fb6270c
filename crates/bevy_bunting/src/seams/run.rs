//! The vertices through which a side of a seam runs.

use crate::cloth::mesh::ClothMesh;
use crate::motion::attached_vertices::{AttachedVertices, ClothEdge};
use crate::seams::error::SeamError;
use crate::seams::seam::SeamRun;

impl SeamRun {
    /// The vertices of a mesh in their order.
    pub(super) fn vertices(&self, mesh: &ClothMesh) -> Result<Vec<u32>, SeamError> {
        match self {
            Self::Vertices(vertices) => {
                let count = mesh.vertex_count();
                match vertices.iter().find(|&&vertex| vertex as usize >= count) {
                    Some(&vertex) => Err(SeamError::Vertex { vertex }),
                    None => Ok(vertices.clone()),
                }
            }
            Self::Through(places) if !places.iter().all(|at| at.is_finite()) => {
                Err(SeamError::Place)
            }
            Self::Through(places) => Ok(AttachedVertices::Nearest(places.clone()).choose(mesh)),
            Self::Edge(edge) => {
                let uv = mesh.uvs();
                let mut vertices = AttachedVertices::Edge(*edge).choose(mesh);
                vertices.sort_by(|&one, &other| {
                    let [one, other] = [one, other].map(|vertex| uv[vertex as usize]);
                    match edge {
                        ClothEdge::Top | ClothEdge::Bottom => one.x.total_cmp(&other.x),
                        ClothEdge::Left | ClothEdge::Right => one.y.total_cmp(&other.y),
                    }
                });
                Ok(vertices)
            }
        }
    }
}
