//! What the cost of a batch depends on.

use bunting_solver::{LaneCount, StepSettings};

/// Properties of a batch on which its cost depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CostKind {
    /// Particles in a lane.
    pub particles: usize,
    pub settings: StepSettings,
    pub lanes: LaneCount,
    /// Whether the cloths may have different fabrics.
    pub mixed: bool,
}

/// Time that a batch took in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BatchTiming {
    pub kind: CostKind,
    /// µs.
    pub time: f32,
}
