//! Colliders: shapes that cloth does not enter.

use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;
use bunting_solver::Collider;
use parry3d::math::Vector;
use parry3d::shape::{SharedShape, TriMesh, TriMeshFlags};

use crate::cloth::reflect::SharedShapeReflect;
use crate::environment::scaled_shape::ScaledShape;
use crate::motion::pose::PoseHistory;

/// A shape that no cloth enters. It moves with its entity and pushes cloth; cloth does not push it. A
/// heightfield is solid below its surface. Scene files can contain it with the feature `serialize`.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_transform::prelude::*;
///
/// // A body, and a table with a smooth top.
/// let body = (ClothCollider::capsule(0.5, 0.25), Transform::from_xyz(0.0, 1.0, 0.0));
/// let table = ClothCollider { friction: 0.2, margin: 0.005, ..ClothCollider::cylinder(0.4, 0.6) };
/// # assert!(!table.features && body.0.friction == 1.0);
/// ```
#[derive(Component, Clone, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Clone)]
#[require(Transform, PoseHistory, ScaledShape)]
pub struct ClothCollider {
    /// The shape in the entity's frame. The scale of the entity in the world multiplies it, at any time; without one it is in m. A
    /// scale that differs from direction to direction makes a round shape a hull of as many corners as it needs, and shear is left
    /// out.
    #[reflect(remote = SharedShapeReflect)]
    pub shape: SharedShape,
    /// Distance that cloth keeps from the shape in addition to its thickness, m, whatever the entity's scale. A margin rounds edges: a box
    /// with a margin is a round box, and cheaper than parry's round cuboid, whose projections are iterative.
    #[reflect(default)]
    pub margin: f32,
    /// Coulomb friction coefficient. A contact uses the geometric mean of this value and the material's.
    #[reflect(default = "friction")]
    pub friction: f32,
    /// Whether edges, corners and parts smaller than the cloth's mesh are felt between its particles, at the levels of
    /// [`ClothFeatures`](crate::ClothFeatures). Off by default: only particles touch, and the cloth, which is straight
    /// between them, shows edges and corners. With particles 3 cm apart the corner of a box stands out by up to 15 mm; a
    /// [`margin`](Self::margin) of that size hides it. On: the corner is covered, at several times the cost, and sheets that lie on
    /// edges tremble, never sleep, and may be stretched or slide off.
    #[reflect(default)]
    pub features: bool,
}

/// Coulomb friction coefficient of colliders unless another is given.
const FRICTION: f32 = 1.0;

/// Friction of a collider in a file that names none.
fn friction() -> f32 {
    FRICTION
}

/// Triangles cannot be a collider.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ColliderError {
    /// No triangle, or only degenerate ones.
    #[error("a collider needs a triangle that is not degenerate")]
    NoTriangle,
    /// An index without a corner.
    #[error("an index of the collider's triangles is out of range")]
    Index,
    /// A position that is not finite.
    #[error("a position of the collider's mesh is not finite")]
    NotFinite,
    /// Not a list of triangles with positions.
    #[error("the collider's mesh must be a list of triangles with positions")]
    Topology,
}

impl ClothCollider {
    /// A collider of any parry shape, without a margin and features, with a friction coefficient of 1.
    #[must_use]
    pub const fn new(shape: SharedShape) -> Self {
        Self { shape, margin: 0.0, friction: FRICTION, features: false }
    }

    /// A ball of the given radius (m).
    #[must_use]
    pub fn ball(radius: f32) -> Self {
        Self::new(SharedShape::ball(radius))
    }

    /// A capsule along y with the given half length of its axis (m) and radius (m).
    #[must_use]
    pub fn capsule(half_height: f32, radius: f32) -> Self {
        Self::new(SharedShape::capsule_y(half_height, radius))
    }

    /// A box of the given half extents (m).
    #[must_use]
    pub fn cuboid(half_extents: Vec3) -> Self {
        Self::new(SharedShape::cuboid(half_extents.x, half_extents.y, half_extents.z))
    }

    /// A cylinder along y with the given half height (m) and radius (m).
    #[must_use]
    pub fn cylinder(half_height: f32, radius: f32) -> Self {
        Self::new(SharedShape::cylinder(half_height, radius))
    }

    /// A cone along y, its tip up, with the given half height (m) and radius of its base (m).
    #[must_use]
    pub fn cone(half_height: f32, radius: f32) -> Self {
        Self::new(SharedShape::cone(half_height, radius))
    }

    /// The convex hull of some points, m; none if they lie in a plane, or if a number is not finite.
    #[must_use]
    pub fn convex_hull(points: &[Vec3]) -> Option<Self> {
        if points.len() < 4 || !points.iter().all(|point| point.is_finite()) {
            return None;
        }
        SharedShape::convex_hull(points).map(Self::new)
    }

    /// A mesh of triangles, given by corners (m) and indices. A closed mesh whose triangles all have their counterclockwise
    /// side outside is solid. Any other mesh is a surface that cloth touches from both sides, with its particles alone; a
    /// solid one can have [`features`](Self::features).
    ///
    /// # Errors
    ///
    /// There is no triangle, an index is out of range, or a number is not finite.
    pub fn triangles(corners: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, ColliderError> {
        let known = corners.len() as u32;
        if triangles.iter().flatten().any(|&corner| corner >= known) {
            return Err(ColliderError::Index);
        }
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(ColliderError::NotFinite);
        }
        let flags = TriMeshFlags::MERGE_DUPLICATE_VERTICES
            | TriMeshFlags::DELETE_DEGENERATE_TRIANGLES
            | TriMeshFlags::DELETE_DUPLICATE_TRIANGLES;
        let mesh = TriMesh::with_flags(corners, triangles, flags);
        let mut mesh = mesh.map_err(|_| ColliderError::NoTriangle)?;
        if is_closed(mesh.indices()) {
            mesh.set_flags(flags | TriMeshFlags::ORIENTED)
                .map_err(|_| ColliderError::NoTriangle)?;
        }
        Ok(Self::new(SharedShape::new(mesh)))
    }

    /// A mesh of triangles from a Bevy mesh, as [`triangles`](Self::triangles), with its positions multiplied by a
    /// scale. On an entity that has that scale, insert [`ScaleInShape`](crate::ScaleInShape), too.
    ///
    /// # Errors
    ///
    /// The mesh has no positions or is not a list of triangles, or as [`triangles`](Self::triangles).
    #[cfg(feature = "render")]
    pub fn from_mesh(mesh: &bevy_mesh::Mesh, scale: Vec3) -> Result<Self, ColliderError> {
        use bevy_mesh::{Mesh, PrimitiveTopology};
        if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            return Err(ColliderError::Topology);
        }
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|it| it.as_float3());
        let positions = positions.ok_or(ColliderError::Topology)?;
        let corners: Vec<Vec3> = positions.iter().map(|&at| Vec3::from(at) * scale).collect();
        let indices: Vec<u32> = match mesh.indices() {
            Some(indices) => indices.iter().map(|index| index as u32).collect(),
            None => (0..corners.len() as u32).collect(),
        };
        // A mirrored mesh has its triangles the wrong way round.
        let mirrored = scale.x * scale.y * scale.z < 0.0;
        let triangle = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        let (triangles, _) = indices.as_chunks();
        Self::triangles(corners, triangles.iter().map(triangle).collect())
    }

    /// The half space below the entity's xz plane.
    #[must_use]
    pub fn ground() -> Self {
        Self::new(SharedShape::halfspace(Vector::Y))
    }

    /// The collider with a shape of its size in a tick, at whose start and end it has these poses (positions in m).
    pub(super) fn between(
        &self,
        shape: &SharedShape,
        from: (Vec3, Quat),
        to: (Vec3, Quat),
    ) -> Collider {
        let Self { margin, friction, features, .. } = *self;
        Collider { shape: shape.clone(), from, to, margin, friction, features, reports_as: None }
    }
}

/// Whether each edge of some triangles belongs to two of them, which have it in opposite directions.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut directed: Vec<[u32; 2]> = edges.collect();
    directed.sort_unstable();
    let is_single = directed.windows(2).all(|pair| pair[0] != pair[1]);
    is_single && directed.iter().all(|&[a, b]| directed.binary_search(&[b, a]).is_ok())
}
