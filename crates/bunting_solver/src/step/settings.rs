//! What a step is told: how finely to solve, and how each cloth is driven.

use glam::Vec3;

use crate::constants::GRAVITY;
use crate::step::frame::FrameMotion;

/// How the constraints are solved, and with which integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Scheme {
    /// The thesis's: Gauss–Seidel over every constraint, backward Euler. PBD, and XPBD where the
    /// material has a compliance. Wants ten substeps or more.
    GaussSeidel,
    /// Each yarn's links solved together, exactly; BDF2, of second order.
    #[default]
    Yarns,
}

/// How finely a batch is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StepSettings {
    /// How the constraints are solved.
    pub scheme: Scheme,
    /// Substeps in a tick; at least 1. More substeps cost in proportion and are worth more than
    /// passes (Macklin 2019, "Small steps in physics simulation").
    pub substeps: u32,
    /// Passes in a substep; at least 1. Gauss–Seidel goes over all constraints in each; yarns solve
    /// warp and weft once more. What cracks and folds sharply wants more passes, what swings more
    /// substeps.
    pub passes: u32,
}

impl StepSettings {
    /// Gauss–Seidel in `substeps` substeps of one pass.
    #[must_use]
    pub const fn gauss_seidel(substeps: u32) -> Self {
        Self { scheme: Scheme::GaussSeidel, substeps, passes: 1 }
    }

    /// Yarns in `substeps` substeps of one pass.
    #[must_use]
    pub const fn yarns(substeps: u32) -> Self {
        Self { scheme: Scheme::Yarns, substeps, passes: 1 }
    }
}

impl Default for StepSettings {
    /// Yarns, two substeps of two passes: for cloth of up to 65 × 65 particles at 60 ticks a second.
    fn default() -> Self {
        Self { passes: 2, ..Self::yarns(2) }
    }
}

/// What acts on one cloth during a tick. Vectors are along the axes of the cloth's frame as it
/// stands at the end of the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// How the cloth's frame moves in this tick.
    pub motion: FrameMotion,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Velocity of the air relative to the world, m/s.
    pub wind: Vec3,
    /// Density of the air, kg/m³.
    pub air_density: f32,
}

impl Drive {
    /// Nothing acts.
    pub const NONE: Self =
        Self { motion: FrameMotion::NONE, gravity: Vec3::ZERO, wind: Vec3::ZERO, air_density: 0.0 };
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
