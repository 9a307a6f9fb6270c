//! Regions: the space in which a wind blows.

use bevy_ecs::prelude::*;
use bevy_math::{Vec3, Vec4};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

use crate::environment::falloff::falloffs;
use crate::environment::wind::places::Places;
use crate::motion::pose::PoseHistory;

/// Bounds the [`WindField`](crate::WindField) of the same entity to a shape, which is placed and moved by the entity's
/// transform. The entity's scale is ignored, and the velocity stays along the world's axes.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // A draught in a gateway, which falls to zero in the outer metre.
/// let gate = WindRegion::cuboid(Vec3::new(2.0, 3.0, 5.0), 1.0);
/// let draught = (WindField::steady(4.0 * Vec3::Z), gate);
/// assert_eq!(gate.weight_at(Vec3::ZERO), 1.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, PoseHistory)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WindRegion {
    /// The shape, in the entity's frame.
    pub shape: WindShape,
    /// Distance inside the border over which the wind falls to zero, m. Zero or less: a sharp border.
    pub falloff: f32,
}

/// Shape of a [`WindRegion`]. Lengths are in m.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A draught in a doorway.
/// let shape = WindShape::Box { half_extents: bevy_math::Vec3::new(0.5, 1.0, 0.3) };
/// # assert_eq!(shape, shape);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum WindShape {
    /// A box around the origin.
    Box {
        /// Half of its edges.
        half_extents: Vec3,
    },
    /// A ball around the origin.
    Sphere {
        /// Its radius.
        radius: f32,
    },
    /// A cone with its tip at the origin, which opens forwards, along −z.
    Cone {
        /// Distance of its base from its tip.
        length: f32,
        /// Radius of its base.
        radius: f32,
    },
    /// A capsule along y, around the origin.
    Capsule {
        /// Half of its axis, without the caps.
        half_height: f32,
        /// Its radius.
        radius: f32,
    },
}

impl WindRegion {
    /// A region of a shape with a falloff (m).
    #[must_use]
    pub const fn new(shape: WindShape, falloff: f32) -> Self {
        Self { shape, falloff }
    }

    /// A box with the given half extents (m) and falloff (m).
    #[must_use]
    pub const fn cuboid(half_extents: Vec3, falloff: f32) -> Self {
        Self::new(WindShape::Box { half_extents }, falloff)
    }

    /// A ball with the given radius (m) and falloff (m).
    #[must_use]
    pub const fn ball(radius: f32, falloff: f32) -> Self {
        Self::new(WindShape::Sphere { radius }, falloff)
    }

    /// The part of the wind at a position in the entity's frame (m).
    #[must_use]
    pub fn weight_at(&self, position: Vec3) -> f32 {
        self.weights_at(&Places::of(&[position]))[0]
    }

    /// The parts of the wind at positions in the entity's frame (m).
    pub(super) fn weights_at(&self, positions: &Places) -> Vec4 {
        falloffs(self.shape.depths(positions), self.falloff)
    }

    /// Radius of the ball around the origin in which the whole wind blows, m; not positive where there is none. The depth
    /// changes by at most a metre a metre.
    pub(super) fn depth_of_core(&self) -> f32 {
        self.shape.depths(&Places::ZERO)[0] - self.falloff.max(0.0)
    }
}

impl Default for WindRegion {
    /// A ball of 10 m in which the wind falls to zero over the outer half.
    fn default() -> Self {
        Self::ball(10.0, 5.0)
    }
}

impl WindShape {
    /// Distances of positions (m) inside the shape from the border; zero or less outside.
    fn depths(&self, positions: &Places) -> Vec4 {
        let Places { x, y, z } = *positions;
        match *self {
            Self::Box { half_extents: half } => {
                (half.x - x.abs()).min(half.y - y.abs()).min(half.z - z.abs())
            }
            Self::Sphere { radius } => radius - roots(x * x + y * y + z * z),
            Self::Cone { length, radius } => {
                let across = roots(x * x + y * y);
                let slant = (length * length + radius * radius).sqrt();
                ((radius * -z - length * across) / slant).min(length + z)
            }
            Self::Capsule { half_height, radius } => {
                let half = Vec4::splat(half_height.max(0.0));
                let off_axis = y - y.max(-half).min(half);
                radius - roots(x * x + off_axis * off_axis + z * z)
            }
        }
    }

    /// Radius of the ball around the origin that contains the shape, m.
    pub(super) fn reach(&self) -> f32 {
        match *self {
            Self::Box { half_extents } => half_extents.length(),
            Self::Sphere { radius } => radius,
            Self::Cone { length, radius } => (length * length + radius * radius).sqrt(),
            Self::Capsule { half_height, radius } => half_height.max(0.0) + radius,
        }
    }
}

/// The square roots of four numbers.
fn roots(squares: Vec4) -> Vec4 {
    Vec4::from_array(squares.to_array().map(f32::sqrt))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_distances_from_the_border() {
        let cuboid = WindShape::Box { half_extents: Vec3::new(1.0, 2.0, 3.0) };
        let sphere = WindShape::Sphere { radius: 2.0 };
        let cone = WindShape::Cone { length: 4.0, radius: 3.0 };
        let capsule = WindShape::Capsule { half_height: 2.0, radius: 1.0 };
        for (shape, at, depth) in [
            (cuboid, Vec3::ZERO, 1.0),
            (cuboid, Vec3::new(0.0, 1.5, 0.0), 0.5),
            (cuboid, Vec3::new(0.0, -2.5, 0.0), -0.5),
            (sphere, Vec3::X * 1.5, 0.5),
            (cone, Vec3::NEG_Z, 0.6),
            (cone, Vec3::NEG_Z * 3.5, 0.5),
            (cone, Vec3::NEG_Z * 4.5, -0.5),
            (cone, Vec3::Z, -0.6),
            (capsule, Vec3::Y * 2.5, 0.5),
            (capsule, Vec3::new(0.25, 1.0, 0.0), 0.75),
        ] {
            let found = shape.depths(&Places::of(&[at]))[0];
            assert!((found - depth).abs() < 1e-6, "{shape:?} at {at}");
            assert!(depth < 0.0 || at.length() <= shape.reach(), "{shape:?} at {at}");
        }
    }
}
