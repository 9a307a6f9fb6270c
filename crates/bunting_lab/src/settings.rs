//! Levels of detail and solver settings that are measured.

use bunting_solver::{Scheme, StepSettings};

use crate::product::DEFAULT;

/// Vertices along each side of a flag, at each level of detail.
pub const LEVELS: [u32; 4] = [33, 17, 9, 5];

/// Settings of each scheme with which time is measured: the solver's defaults.
#[must_use]
pub fn schemes() -> [StepSettings; 2] {
    [DEFAULT, StepSettings::gauss_seidel(10)]
}

/// Name of a scheme in tables and in JSON.
#[must_use]
pub fn scheme_name(settings: StepSettings) -> &'static str {
    match settings.scheme {
        Scheme::GaussSeidel => "gauss_seidel",
        Scheme::Yarns => "yarns",
    }
}

/// Settings of each level where levels change with the distance, the finest first: distant cloth is solved
/// more coarsely.
#[must_use]
pub fn steps_of_levels() -> Vec<StepSettings> {
    let coarse = StepSettings { substeps: 1, ..DEFAULT };
    vec![DEFAULT, coarse, coarse, coarse]
}
