//! Where in the tick a batch is.

use crate::step::StepSettings;

/// Where in the tick a batch is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    pub settings: StepSettings,
    /// Length of a substep, s.
    pub step: f32,
    /// Substeps begun in this tick; `integrate` counts them.
    pub begun: u32,
    /// Whether a substep is under way: positions are predictions.
    pub predicted: bool,
}

impl Clock {
    /// Whether the tick has no length, or none that can be computed with: then nothing moves.
    pub fn stands_still(&self) -> bool {
        !(self.step > 0.0 && self.step.is_finite())
    }
}
