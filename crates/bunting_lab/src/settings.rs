//! Levels of detail and solver settings that are measured.

use bunting_solver::{Scheme, StepSettings};

use crate::product::DEFAULT;

/// Vertices along each side of a flag, at each level of detail.
pub const LEVELS: [u32; 4] = [33, 17, 9, 5];

/// How finely each scheme is solved where time is measured: the settings that the solver proposes.
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

/// How finely each level is solved where levels change with the distance, the finest first: what is far
/// away is solved more coarsely.
#[must_use]
pub fn steps_of_levels() -> Vec<StepSettings> {
    let coarse = StepSettings { substeps: 1, ..DEFAULT };
    vec![DEFAULT, coarse, coarse, coarse]
}
