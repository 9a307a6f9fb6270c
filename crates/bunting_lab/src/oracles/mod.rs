//! Expected results where mathematics gives them: closed forms, or small problems solved far more exactly
//! than any tolerance. [`trials`] compares them with a cloth. No expected value comes from a cloth
//! simulation.

pub mod bending;
pub mod catenary;
pub mod drag;
pub mod dumbbell;
pub mod free_fall;
pub mod pendulum;
pub mod rig;
pub mod root;
pub mod stretch;
pub mod trials;

use serde::Serialize;

/// A closed form and a measurement of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Name, with the parameters that distinguish the case from others of its trial.
    pub name: String,
    /// Expected value by the closed form, SI units.
    pub expected: f64,
    /// Measured value of the cloth, SI units.
    pub measured: f64,
    /// Difference of the two over the magnitude of the expected value.
    pub relative_error: f64,
    /// Largest relative error that passes.
    pub tolerance: f64,
    /// Whether it passed.
    pub pass: bool,
}

impl Case {
    /// A case from its measurement.
    #[must_use]
    pub fn new(name: impl Into<String>, expected: f64, measured: f64, tolerance: f64) -> Self {
        let relative_error = ((measured - expected) / expected).abs();
        Self {
            name: name.into(),
            expected,
            measured,
            relative_error,
            tolerance,
            pass: relative_error <= tolerance,
        }
    }
}

#[cfg(test)]
mod tests;
