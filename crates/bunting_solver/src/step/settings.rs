//! The input of a step: scheme, substeps and passes of a batch, and the forces on each cloth.

use glam::Vec3;

use crate::constants::GRAVITY;
use crate::step::frame::FrameMotion;

/// Constraint solver and integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Hash, Clone)
)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Scheme {
    /// The thesis's scheme (4.4): Gauss–Seidel over single constraints, and backward Euler. It is PBD, and
    /// XPBD if the material has a compliance. It needs ten substeps or more.
    GaussSeidel,
    /// All links of a yarn are solved at once, exactly, as a tridiagonal system. The integrator is the mean
    /// of BDF2 and BDF3, of second order.
    #[default]
    Yarns,
}

/// Scheme, substeps and passes of a batch.
///
/// ```
/// use bunting_solver::StepSettings;
///
/// let twice = StepSettings { passes: 2, ..StepSettings::yarns(4) };
/// # assert_eq!((twice.substeps, twice.passes), (4, 2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepSettings {
    /// Constraint solver and integrator.
    pub scheme: Scheme,
    /// Number of substeps in a tick; at least 1. The cost is proportional to it. Substeps improve accuracy
    /// more than passes do (Macklin 2019, "Small steps in physics simulation").
    pub substeps: u32,
    /// Number of passes in a substep; at least 1. Gauss–Seidel solves all constraints in each; the scheme of
    /// yarns solves warp and weft once more in each. Cloth that snaps or folds sharply needs more passes, cloth that swings more
    /// substeps.
    pub passes: u32,
}

impl StepSettings {
    /// The Gauss–Seidel scheme with `substeps` substeps of one pass.
    #[must_use]
    pub const fn gauss_seidel(substeps: u32) -> Self {
        Self { scheme: Scheme::GaussSeidel, substeps, passes: 1 }
    }

    /// The scheme of yarns with `substeps` substeps of one pass.
    #[must_use]
    pub const fn yarns(substeps: u32) -> Self {
        Self { scheme: Scheme::Yarns, substeps, passes: 1 }
    }
}

impl Default for StepSettings {
    /// The scheme of yarns with two substeps of two passes: for cloth of up to 65 × 65 particles at 60 ticks a
    /// second. [`StepLimits`](crate::StepLimits) choose substeps for other ticks.
    fn default() -> Self {
        Self { passes: 2, ..Self::yarns(2) }
    }
}

/// Frame motion, gravity and air that act on one cloth during a tick. Vectors are along the axes of the
/// cloth's frame at the end of the tick.
///
/// ```
/// use bunting_solver::Drive;
/// use glam::Vec3;
///
/// // A breeze on the Moon.
/// let drive = Drive { gravity: 1.62 * Vec3::NEG_Y, wind: 3.0 * Vec3::X, ..Drive::default() };
/// # assert!(drive.motion.is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Motion of the cloth's frame in this tick.
    pub motion: FrameMotion,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Velocity of the air relative to the world, m/s.
    pub wind: Vec3,
    /// Density of the air, kg/m³.
    pub air_density: f32,
}

impl Drive {
    /// A frame at rest, without gravity and air.
    pub const NONE: Self =
        Self { motion: FrameMotion::NONE, gravity: Vec3::ZERO, wind: Vec3::ZERO, air_density: 0.0 };

    /// Names the first field that is not finite, or the air's density if it is negative.
    pub(crate) fn validate(&self) -> Result<(), &'static str> {
        let motion = &self.motion;
        let checks = [
            ("motion", motion.rotation.is_finite() && motion.translation.is_finite()),
            ("gravity", self.gravity.is_finite()),
            ("wind", self.wind.is_finite()),
            ("air_density", self.air_density >= 0.0 && self.air_density.is_finite()),
        ];
        checks.iter().find(|(_, is_valid)| !is_valid).map_or(Ok(()), |&(name, _)| Err(name))
    }
}

/// Standard density of air at sea level and 15 °C, kg/m³.
const AIR_DENSITY: f32 = 1.225;

impl Default for Drive {
    /// A frame at rest, y up, standard gravity, still air.
    fn default() -> Self {
        Self {
            motion: FrameMotion::NONE,
            gravity: Vec3::new(0.0, -GRAVITY, 0.0),
            wind: Vec3::ZERO,
            air_density: AIR_DENSITY,
        }
    }
}
