//! What the cloth should do where mathematics knows it: closed forms, or small problems solved to far
//! below any tolerance, and in [`trials`] what a cloth does instead. Nothing expected comes from a
//! cloth simulation.

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

/// A closed form beside a measurement of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Name, with the parameters that tell it from its siblings.
    pub name: String,
    /// What mathematics says, SI units.
    pub expected: f64,
    /// What the cloth did, SI units.
    pub measured: f64,
    /// Distance of the two over the size of the expected.
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
