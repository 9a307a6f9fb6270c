//! The vertices that an attachment holds: an edge, corners, a list, a rectangle, places, a border, points on triangles.

use bevy_math::{Vec2, Vec3};
use bevy_reflect::Reflect;
use bunting_solver::MeshPoint;

use crate::cloth::mesh::ClothMesh;
use crate::motion::border::border_near;

/// Greatest distance in texture coordinates of a vertex on an edge from the extreme coordinate. Smaller:
/// rounding excludes vertices. Larger: an edge holds several rows of fine meshes.
const EDGE_TOLERANCE: f32 = 1e-4;

/// An edge of a cloth, by texture coordinate: u grows to the right and v down.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A curtain hangs by its upper edge.
/// let hung = Attachment::in_place(ClothEdge::Top);
/// # assert_eq!(hung.vertices, AttachedVertices::Edge(ClothEdge::Top));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum ClothEdge {
    /// Least u.
    Left,
    /// Greatest u.
    Right,
    /// Least v.
    Top,
    /// Greatest v.
    Bottom,
}

/// A corner of a cloth, by texture coordinate: u grows to the right and v down.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A sheet on a line, by two pegs.
/// let pegs = AttachedVertices::Corners(vec![ClothCorner::TopLeft, ClothCorner::TopRight]);
/// # Attachment::in_place(pegs);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum ClothCorner {
    /// Least u and v.
    TopLeft,
    /// Greatest u, least v.
    TopRight,
    /// Least u, greatest v.
    BottomLeft,
    /// Greatest u and v.
    BottomRight,
}

/// The vertices that an [`Attachment`](crate::Attachment) holds.
///
/// A coarser level of a grid holds those of the vertices that it has. A mesh that is no grid is held at all of them and at all points at
/// each level, and between those vertices that an edge joins.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Every fourth vertex along the top of a grid of 33 columns.
/// let rings = AttachedVertices::List((0..33).step_by(4).collect());
/// # Attachment::in_place(rings);
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum AttachedVertices {
    /// All vertices on an edge.
    Edge(ClothEdge),
    /// For each of these corners, the vertex nearest to it.
    Corners(Vec<ClothCorner>),
    /// Vertices of the [`ClothMesh`](crate::ClothMesh) by index; of a grid, by `row * columns +
    /// column`.
    List(Vec<u32>),
    /// All vertices whose texture coordinate lies in a rectangle or on its border. For other shapes, see
    /// [`AttachedVertices::list_where`].
    Within {
        /// Least u and v.
        low: Vec2,
        /// Greatest u and v.
        high: Vec2,
    },
    /// For each of these places in the mesh's own frame, m, the vertex nearest to it at rest.
    Nearest(Vec<Vec3>),
    /// All vertices that lie at rest in a box in the mesh's own frame or on its border, m. A box that is flat, but for a tolerance
    /// of the caller's, holds a line of vertices.
    InBox {
        /// Least x, y and z, m.
        low: Vec3,
        /// Greatest x, y and z, m.
        high: Vec3,
    },
    /// All vertices on the border that passes nearest to a place in the mesh's own frame at rest, m: the waist of a skirt, the neck
    /// of a cape, the rim of a hole. A border is followed all around, across doubled vertices.
    Border {
        /// A place at or near the border, m.
        near: Vec3,
    },
    /// Points on the triangles of the [`ClothMesh`](crate::ClothMesh), each held where it is told as exactly as a vertex, by a
    /// particle of the simulation's own. Two points hold nothing between them. The vertices of the mesh, which is drawn, stay as they
    /// are.
    ///
    /// A [`ClothMesh::grid`](crate::ClothMesh::grid) with points beside its vertices is simulated with about as many particles of
    /// the simulation's own as it has vertices, as other meshes are, see [`ClothResolution`](crate::ClothResolution); this takes more
    /// time. With points at vertices alone it stays a grid.
    ///
    /// ```
    /// use bevy_bunting::prelude::*;
    /// use bevy_math::Vec3;
    ///
    /// // A sheet of two triangles hangs by two pegs, neither of them at a vertex.
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::NEG_Y, Vec3::new(1.0, -1.0, 0.0)];
    /// let sheet = ClothMesh::triangles(corners.to_vec(), vec![0, 2, 1, 1, 2, 3], vec![]);
    /// let pegs = vec![
    ///     // In the middle of the first triangle, and on its upper edge, a tenth of the way from vertex 1.
    ///     MeshPoint::middle([0, 2, 1]),
    ///     MeshPoint { vertices: [0, 2, 1], weights: [0.1, 0.0, 0.9] },
    /// ];
    /// let held = Attachment::in_place(AttachedVertices::Points(pegs));
    /// // Or where a place is known, but no triangle.
    /// let peg = sheet.nearest_point(Vec3::new(0.4, -0.2, 0.0));
    /// # assert!(peg.is_some_and(|peg| peg.vertex().is_none()) && held.anchors.is_empty());
    /// ```
    Points(Vec<MeshPoint>),
    /// No vertices but the rigid ones, which the mesh names itself by a weight of 0, see
    /// [`ClothMesh::with_weights`](crate::ClothMesh::with_weights): they follow the target.
    Rigid,
}

impl AttachedVertices {
    /// [`List`](Self::List) of the vertices of a mesh whose texture coordinates satisfy a predicate; empty
    /// for a mesh without texture coordinates.
    #[must_use]
    pub fn list_where(mesh: &ClothMesh, holds: impl Fn(Vec2) -> bool) -> Self {
        let chosen = (0..).zip(mesh.uvs()).filter(|&(_, uv)| holds(uv));
        Self::List(chosen.map(|(vertex, _)| vertex).collect())
    }

    /// Indices of the held vertices of a mesh.
    pub(crate) fn choose(&self, mesh: &ClothMesh) -> Vec<u32> {
        match self {
            Self::List(vertices) => vertices.clone(),
            Self::Points(points) => points.iter().filter_map(MeshPoint::vertex).collect(),
            Self::Nearest(places) => {
                let builder = mesh.builder();
                places.iter().filter_map(|&to| nearest_to(builder.positions(), to)).collect()
            }
            Self::InBox { low, high } => {
                let builder = mesh.builder();
                let within = |at: Vec3| at.cmpge(*low).all() && at.cmple(*high).all();
                let chosen = (0..).zip(builder.positions()).filter(|&(_, &at)| within(at));
                chosen.map(|(vertex, _)| vertex).collect()
            }
            Self::Border { near } => border_near(mesh, *near),
            Self::Rigid => Vec::new(),
            Self::Edge(_) | Self::Corners(_) | Self::Within { .. } => self.by_uv(&mesh.uvs()),
        }
    }

    /// Place of what is held first, in the mesh's own frame, m: of a vertex or, where there is none, of a point. None if nothing
    /// is held.
    pub(crate) fn first_place(&self, mesh: &ClothMesh) -> Option<Vec3> {
        let builder = mesh.builder();
        let vertex = self.choose(mesh).first().copied();
        let of_vertex = vertex.and_then(|vertex| builder.positions().get(vertex as usize).copied());
        of_vertex.or_else(|| builder.place(&self.points().next()?))
    }

    /// Indices of the vertices that are chosen by texture coordinates.
    fn by_uv(&self, uv: &[Vec2]) -> Vec<u32> {
        let low = uv.iter().copied().reduce(Vec2::min).unwrap_or_default();
        let high = uv.iter().copied().reduce(Vec2::max).unwrap_or_default();
        let all_where = |holds: &dyn Fn(Vec2) -> bool| {
            (0..).zip(uv).filter(|&(_, &uv)| holds(uv)).map(|(vertex, _)| vertex).collect()
        };
        match self {
            Self::Edge(ClothEdge::Left) => all_where(&|uv| uv.x <= low.x + EDGE_TOLERANCE),
            Self::Edge(ClothEdge::Right) => all_where(&|uv| uv.x >= high.x - EDGE_TOLERANCE),
            Self::Edge(ClothEdge::Top) => all_where(&|uv| uv.y <= low.y + EDGE_TOLERANCE),
            Self::Edge(ClothEdge::Bottom) => all_where(&|uv| uv.y >= high.y - EDGE_TOLERANCE),
            Self::Corners(corners) => {
                corners.iter().filter_map(|corner| nearest(uv, corner.of(low, high))).collect()
            }
            Self::Within { low, high } => {
                all_where(&|at: Vec2| at.cmpge(*low).all() && at.cmple(*high).all())
            }
            _ => Vec::new(),
        }
    }

    /// The held points that are not at vertices.
    pub(crate) fn points(&self) -> impl Iterator<Item = MeshPoint> {
        let points = match self {
            Self::Points(points) => &points[..],
            _ => &[],
        };
        points.iter().copied().filter(|point| point.vertex().is_none())
    }
}

impl From<ClothEdge> for AttachedVertices {
    fn from(edge: ClothEdge) -> Self {
        Self::Edge(edge)
    }
}

impl From<u32> for AttachedVertices {
    /// One vertex, by its index in the [`ClothMesh`](crate::ClothMesh).
    fn from(vertex: u32) -> Self {
        Self::List(vec![vertex])
    }
}

impl From<ClothCorner> for AttachedVertices {
    fn from(corner: ClothCorner) -> Self {
        Self::Corners(vec![corner])
    }
}

impl ClothCorner {
    fn of(self, low: Vec2, high: Vec2) -> Vec2 {
        match self {
            Self::TopLeft => low,
            Self::TopRight => Vec2::new(high.x, low.y),
            Self::BottomLeft => Vec2::new(low.x, high.y),
            Self::BottomRight => high,
        }
    }
}

/// The vertex nearest to a place, of equally near ones the first.
fn nearest_to(positions: &[Vec3], to: Vec3) -> Option<u32> {
    (0..)
        .zip(positions)
        .min_by(|(_, a), (_, b)| a.distance_squared(to).total_cmp(&b.distance_squared(to)))
        .map(|(vertex, _)| vertex)
}

fn nearest(uv: &[Vec2], corner: Vec2) -> Option<u32> {
    (0..)
        .zip(uv)
        .min_by(|(_, a), (_, b)| a.distance_squared(corner).total_cmp(&b.distance_squared(corner)))
        .map(|(vertex, _)| vertex)
}

#[cfg(test)]
#[path = "attached_vertices_tests.rs"]
mod tests;
