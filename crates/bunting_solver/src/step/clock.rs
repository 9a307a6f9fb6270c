//! The position of a batch within the tick.

use crate::step::StepSettings;

/// The position of a batch within the tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    pub settings: StepSettings,
    /// Length of a substep, s.
    pub step: f32,
    /// Number of substeps begun in this tick; `integrate` counts them.
    pub begun: u32,
    /// Whether a substep is under way, so that positions are predictions.
    pub predicted: bool,
}

impl Clock {
    /// Whether the length of the tick is zero or invalid, so that nothing moves.
    pub fn stands_still(&self) -> bool {
        !(self.step > 0.0 && self.step.is_finite())
    }
}
