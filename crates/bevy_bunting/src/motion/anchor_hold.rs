//! How an anchor holds its vertices.

use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// How an [`Anchor`](crate::Anchor) holds its vertices. Frames are those of the anchor: its target's pose times the offset.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // Rings of 10 g on a rail of 2 m.
/// let points = vec![Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)];
/// let rail = AnchorHold::Rail { points, ring_mass: 0.01, friction: 0.1 };
/// # assert_ne!(rail, AnchorHold::default());
/// ```
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum AnchorHold {
    /// At their places, exactly.
    #[default]
    Rigid,
    /// By springs to their places.
    Spring {
        /// Stiffness of all springs together, N/m.
        stiffness: f32,
        /// Greatest force of all springs together, N: those that would pull harder yield. May be infinite.
        #[reflect(default = "infinite_force")]
        max_force: f32,
    },
    /// By rings on a rail, one for each vertex, which slide.
    Rail {
        /// The corners of the rail, m: two are a straight rail, one is a hook. Rings stop at its ends, and those that are
        /// not on it come to it at 2 m/s.
        points: Vec<Vec3>,
        /// Mass of each ring, kg. A ring yields to a load of W (N) by W τ²/mass for a moment, with τ = 5 ms at two substeps
        /// in a tick of 1/60 s: 10 g carry 0.1 N within 0.25 mm.
        ring_mass: f32,
        /// Coulomb friction coefficient of rings on the rail.
        friction: f32,
    },
}

/// Force in a file that names none, N: JSON cannot write infinity.
pub(crate) fn infinite_force() -> f32 {
    f32::INFINITY
}

impl AnchorHold {
    /// Whether the vertices are pinned.
    pub(crate) fn is_rigid(&self) -> bool {
        *self == Self::Rigid
    }

    /// Whether all numbers can be used.
    pub(crate) fn is_valid(&self) -> bool {
        let is_positive = |value: f32| value.is_finite() && value > 0.0;
        match self {
            Self::Rigid => true,
            Self::Spring { stiffness, max_force } => is_positive(*stiffness) && *max_force >= 0.0,
            Self::Rail { points, ring_mass, friction } => {
                !points.is_empty()
                    && points.iter().all(|at| at.is_finite())
                    && is_positive(*ring_mass)
                    && friction.is_finite()
                    && *friction >= 0.0
            }
        }
    }
}
