//! A side of a seam, and the vertices through which it runs.

use bevy_math::Vec3;
use bevy_reflect::Reflect;

use crate::cloth::mesh::ClothMesh;
use crate::motion::attached_vertices::{AttachedVertices, ClothEdge};
use crate::seams::error::SeamError;

/// One side of a [`Seam`](crate::Seam): a way along a cloth from its beginning to its end.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // The left edge of a panel at x = 1 m in the mesh's frame, from the top to the hem.
/// let side = SeamRun::Through(vec![Vec3::X, Vec3::new(1.0, -0.5, 0.0)]);
/// # assert_ne!(side, SeamRun::Edge(ClothEdge::Left));
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum SeamRun {
    /// An edge by texture coordinates: from the left to the right, or from the top to the bottom. It lies in one piece of the cloth.
    Edge(ClothEdge),
    /// Straight from vertex to vertex of the [`ClothMesh`](crate::ClothMesh) at rest, in this order: the two ends of a straight edge, or
    /// all vertices along a curved one.
    Vertices(Vec<u32>),
    /// Straight from place to place at rest, m, in the mesh's own frame, each moved to the vertex that is nearest.
    Through(Vec<Vec3>),
}

impl From<ClothEdge> for SeamRun {
    fn from(edge: ClothEdge) -> Self {
        Self::Edge(edge)
    }
}

impl From<Vec<u32>> for SeamRun {
    /// Straight from vertex to vertex.
    fn from(vertices: Vec<u32>) -> Self {
        Self::Vertices(vertices)
    }
}

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
