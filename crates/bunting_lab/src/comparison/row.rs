//! One method on one scene.

use serde::Serialize;

use crate::{
    contender::Contender,
    observation::Observation,
    reference::Reference,
    scenes::{Measure, Scene},
    timing::Timing,
};

/// Entry of `COMPARED_TICKS` at which a row's position error is taken: 0.4 s.
pub const COMPARED: usize = 1;
/// Greatest ratio of the reference's own error to a position error at which the latter is reported.
const KNOWN: f64 = 0.1;

/// One method on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Scene.
    pub scene: &'static str,
    /// Vertices along each side.
    pub n: usize,
    /// Method.
    pub method: String,
    /// Substeps a tick.
    pub substeps: usize,
    /// Passes a substep.
    pub passes: usize,
    /// Cloths advanced at once.
    pub lanes: usize,
    /// Median time of a tick of one cloth, µs.
    pub us_per_cloth_tick: f64,
    /// Shortest time of a tick of one cloth, µs.
    pub us_min: f64,
    /// Distance from the reference at 0.4 s, m RMS; none if the reference's own error is too large.
    pub rms_error_m: Option<f64>,
    /// Mean of |ε| over warp and weft, in the scene's window.
    pub mean_stretch: f64,
    /// Maximum of |ε| over warp and weft.
    pub max_stretch: f64,
    /// Distance of the mean strain from the reference's.
    pub strain_error: f64,
    /// Distance of the lower free corner's mean position from the reference's, m.
    pub tip_error_m: f64,
    /// Whether all positions stayed finite and near.
    pub stable: bool,
}

impl Row {
    /// Row of a contender's run, from its observation and the times of its ticks.
    #[must_use]
    pub fn new(
        scene: &Scene,
        contender: &Contender,
        seen: &Observation,
        time: &Timing,
        reference: &Reference,
    ) -> Self {
        let target = &reference.observation;
        Self {
            scene: scene.name,
            n: scene.columns,
            method: contender.method.clone(),
            substeps: contender.substeps,
            passes: contender.passes,
            lanes: contender.lanes,
            us_per_cloth_tick: time.median() / contender.lanes as f64,
            us_min: time.min() / contender.lanes as f64,
            rms_error_m: seen
                .rms_error(target, COMPARED)
                .filter(|error| reference.step_errors[COMPARED] < KNOWN * error),
            mean_stretch: seen.strain.mean,
            max_stretch: seen.strain.max,
            strain_error: (seen.strain.mean - target.strain.mean).abs(),
            tip_error_m: seen.tip.distance(target.tip),
            stable: seen.stable,
        }
    }

    /// The error for which the scene is measured, and its name.
    #[must_use]
    pub fn error(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::Positions => self.rms_error_m,
            Measure::Rest | Measure::Statistics => Some(self.strain_error),
        }
        .filter(|error| self.stable && *error > 0.0)
    }
}

/// A method that would take too long on a scene, or does not support it.
#[derive(Clone, Debug, Serialize)]
pub struct LeftOut {
    /// Scene.
    pub scene: &'static str,
    /// Vertices along each side.
    pub n: usize,
    /// Method.
    pub method: String,
    /// Substeps a tick.
    pub substeps: usize,
    /// Passes a substep.
    pub passes: usize,
}

impl LeftOut {
    /// A contender that was not measured on a scene.
    #[must_use]
    pub fn new(scene: &Scene, contender: &Contender) -> Self {
        Self {
            scene: scene.name,
            n: scene.columns,
            method: contender.method.clone(),
            substeps: contender.substeps,
            passes: contender.passes,
        }
    }
}
