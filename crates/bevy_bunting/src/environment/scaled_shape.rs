//! Shapes of another size.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use parry3d::shape::{SharedShape, TriMesh, TypedShape};

/// Number of pieces into which round shapes are divided that become longer in one direction than in another. Fewer: corners
/// show. More: contacts cost more.
const SUBDIVISIONS: u32 = 16;

/// Part of itself by which a scale may be another while a shape stays as it is. Smaller: a collider that grows with a cloth gets
/// a new shape in each tick. Larger: sizes are visibly wrong.
const SAME: f32 = 1e-5;

/// A shape multiplied by a scale. None if no shape is like that: a side is zero or not finite, or it cannot be mirrored.
fn scaled(shape: &SharedShape, scale: Vec3) -> Option<SharedShape> {
    if scale == Vec3::ONE {
        return Some(shape.clone());
    }
    if !scale.is_finite() || scale.cmpeq(Vec3::ZERO).any() {
        return None;
    }
    if scale.cmpgt(Vec3::ZERO).all() {
        return shape.scale_dyn(scale, SUBDIVISIONS).map(|scaled| SharedShape(scaled.into()));
    }
    match shape.as_typed_shape() {
        // Shapes that are their own mirror images.
        TypedShape::Ball(_)
        | TypedShape::Cuboid(_)
        | TypedShape::Cylinder(_)
        | TypedShape::RoundCuboid(_)
        | TypedShape::RoundCylinder(_) => scaled(shape, scale.abs()),
        TypedShape::Capsule(_) => {
            shape.scale_dyn(scale, SUBDIVISIONS).map(|scaled| SharedShape(scaled.into()))
        }
        TypedShape::Cone(_) | TypedShape::RoundCone(_) if scale.y > 0.0 => {
            scaled(shape, scale.abs())
        }
        TypedShape::TriMesh(mesh) => mirrored(mesh, scale),
        _ => None,
    }
}

/// A mesh with a scale of which a component is negative.
fn mirrored(mesh: &TriMesh, scale: Vec3) -> Option<SharedShape> {
    let corners = mesh.vertices().iter().map(|&corner| corner * scale).collect();
    let is_turned = scale.element_product() < 0.0;
    // The outside stays the outside.
    let turned = |&[a, b, c]: &[u32; 3]| if is_turned { [a, c, b] } else { [a, b, c] };
    let triangles = mesh.indices().iter().map(turned).collect();
    let mesh = TriMesh::with_flags(corners, triangles, mesh.flags());
    mesh.ok().map(SharedShape::new)
}

/// The shape of a collider in another size.
#[derive(Component, Clone)]
pub(crate) struct ScaledShape {
    /// None: it is the collider's own.
    shape: Option<SharedShape>,
    /// The collider's own shape when this was made; none before that.
    own: Option<SharedShape>,
    /// The scale that was asked for.
    asked: Vec3,
    /// The scale that the shape has.
    scale: Vec3,
}

impl Default for ScaledShape {
    fn default() -> Self {
        Self { shape: None, own: None, asked: Vec3::ONE, scale: Vec3::ONE }
    }
}

impl ScaledShape {
    /// The shape, m, of a collider with this shape.
    pub fn of<'a>(&'a self, own: &'a SharedShape) -> &'a SharedShape {
        self.shape.as_ref().unwrap_or(own)
    }

    /// The scale that the shape has.
    pub fn scale(&self) -> Vec3 {
        self.scale
    }

    /// Makes the shape of a collider with this shape and a scale, unless it has that. Whether a scale that it cannot have is to be
    /// reported: it then keeps its size.
    pub fn set(&mut self, own: &SharedShape, asked: Vec3) -> bool {
        let asked = without_rounding(asked);
        let is_known = self.own.as_ref().is_some_and(|known| is_same(known, own));
        if is_near(self.asked, asked) && (is_known || (self.own.is_none() && asked == Vec3::ONE)) {
            return false;
        }
        let was_good = self.asked == self.scale;
        (self.own, self.asked) = (Some(own.clone()), asked);
        match scaled(own, asked) {
            Some(shape) => {
                (self.shape, self.scale) = (Some(shape), asked);
                false
            }
            None if is_known => was_good,
            None => {
                (self.shape, self.scale) = (None, Vec3::ONE);
                true
            }
        }
    }
}

/// Whether two handles are of one shape.
fn is_same(one: &SharedShape, other: &SharedShape) -> bool {
    core::ptr::addr_eq(&raw const *one.0, &raw const *other.0)
}

/// A scale of which components that differ by rounding alone are equal, and one where they are one, as products of turns and scales of a
/// skeleton's bones are not: a capsule of another scale in one direction is a polyhedron.
fn without_rounding(scale: Vec3) -> Vec3 {
    let equal = [Vec3::ONE, Vec3::splat(scale.x)].into_iter().find(|it| is_near(*it, scale));
    equal.unwrap_or(scale)
}

/// Whether two scales are the same but for rounding.
fn is_near(one: Vec3, other: Vec3) -> bool {
    (one - other).abs().cmple(one.abs() * SAME).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scale of the third of three bones, each turned, of a figure of a size.
    fn of_turned_bones(size: f32) -> Vec3 {
        let bone = |turn: f32| {
            bevy_math::Mat3::from_rotation_x(turn) * bevy_math::Mat3::from_rotation_y(1.3 * turn)
        };
        let axes = size * bone(0.7) * bone(1.9) * bone(-0.4);
        Vec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length())
    }

    #[test]
    fn capsules_on_turned_bones_stay_capsules() {
        let own = SharedShape::capsule_y(0.2, 0.05);
        for size in [1.0, 1.3] {
            let scale = of_turned_bones(size) * Vec3::new(1.0, 1.000_001, 0.999_999);
            let mut scaled = ScaledShape::default();
            assert!(!scaled.set(&own, scale));
            let radius = scaled.of(&own).as_capsule().map(|capsule| capsule.radius);
            assert!(radius.is_some_and(|it| (it - 0.05 * size).abs() < 1e-6), "{radius:?}");
        }
        let mut stretched = ScaledShape::default();
        assert!(!stretched.set(&own, Vec3::new(1.0, 1.5, 1.0)));
        assert!(stretched.of(&own).as_convex_polyhedron().is_some());
    }
}
