//! A method that can be run on the scenes, and its name in tables.

use crate::{
    baselines::{Baseline, Method},
    scenes::Scene,
    simulation::Simulation,
};

/// Largest n for implicit Euler: beyond it the factorisation takes most of a comparison's time.
const LARGEST_IMPLICIT: usize = 33;

/// Starts a method on a scene; none if the method does not support the scene.
pub type Start = dyn Fn(&Scene) -> Option<Box<dyn Simulation>>;

/// A method with its settings.
pub struct Contender {
    /// Name of the method.
    pub method: String,
    /// Substeps a tick.
    pub substeps: usize,
    /// Passes a substep.
    pub passes: usize,
    /// Cloths advanced at once, all alike, by one call of `tick`.
    pub lanes: usize,
    /// Starts the method.
    pub start: Box<Start>,
}

impl From<Baseline> for Contender {
    fn from(baseline: Baseline) -> Self {
        Self {
            method: baseline.method.to_string(),
            substeps: baseline.substeps,
            passes: baseline.passes,
            lanes: 1,
            start: Box::new(move |scene| {
                let beyond =
                    baseline.method == Method::ImplicitEuler && scene.columns > LARGEST_IMPLICIT;
                (!beyond).then(|| baseline.start(scene))
            }),
        }
    }
}
