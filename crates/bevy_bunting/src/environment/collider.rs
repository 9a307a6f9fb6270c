//! Colliders: shapes that cloth does not enter.

use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;
use bunting_solver::Collider;
use parry3d::math::Vector;
use parry3d::shape::SharedShape;

use crate::cloth::reflect::SharedShapeReflect;
use crate::motion::pose::PoseHistory;

/// A shape that no cloth enters. It moves with its entity and pushes cloth; cloth does not push it. A
/// heightfield is solid below its surface. Scene files can contain it with the feature `serialize`.
#[derive(Component, Clone, Reflect)]
#[reflect(Component, Clone)]
#[require(Transform, PoseHistory)]
pub struct ClothCollider {
    /// The shape in the entity's frame, m; the entity's scale is ignored.
    #[reflect(remote = SharedShapeReflect)]
    pub shape: SharedShape,
    /// Distance that cloth keeps from the shape in addition to its thickness, m. A margin rounds edges: a box
    /// with a margin is a round box, and cheaper than parry's round cuboid, whose projections are iterative.
    pub margin: f32,
    /// Coulomb friction coefficient. A contact uses the geometric mean of this value and the material's.
    pub friction: f32,
}

impl ClothCollider {
    /// A collider of any parry shape, without a margin, with a friction coefficient of 1.
    #[must_use]
    pub const fn new(shape: SharedShape) -> Self {
        Self { shape, margin: 0.0, friction: 1.0 }
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

    /// The half space below the entity's xz plane.
    #[must_use]
    pub fn ground() -> Self {
        Self::new(SharedShape::halfspace(Vector::Y))
    }

    /// The collider in a tick, at whose start and end it has these poses (positions in m).
    pub(super) fn between(&self, from: (Vec3, Quat), to: (Vec3, Quat)) -> Collider {
        let Self { shape, margin, friction } = self.clone();
        Collider { from, to, margin, friction, ..Collider::fixed(shape, from.0, from.1) }
    }
}
