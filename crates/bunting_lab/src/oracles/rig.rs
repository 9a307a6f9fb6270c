//! Strips, measurements and labels that the trials share.

use bunting_solver::{Scheme, StepSettings};
use glam::DVec3;

use super::Case;
use crate::{
    product::DEFAULT,
    reference::grid::Grid,
    scenes::{Fabric, Pins, Pose, Scene, TICK_RATE},
    specimen::Specimen,
};

/// The scheme under trial, with default settings.
pub const YARNS: StepSettings = DEFAULT;
/// The thesis's scheme, with enough substeps for a comparison.
pub const GAUSS_SEIDEL: StepSettings = StepSettings::gauss_seidel(20);
/// Settings of a scheme by number of substeps.
pub type Substeps = fn(u32) -> StepSettings;

/// Tolerance of an observed order of convergence.
const ORDER: f64 = 0.3;

/// A fabric whose columns hang independently: without shear and bending, and with negligible warp stiffness.
#[must_use]
pub const fn chains(stiffness: f64) -> Fabric {
    Fabric { stretch: [1e-2, stiffness], shear: 0.0, bending: 0.0, ..Fabric::STANDARD }
}

/// A strip of two columns with `segments` square cells over `length` metres.
#[must_use]
pub fn strip(segments: usize, length: f64, pins: Pins, pose: Pose, fabric: Fabric) -> Scene {
    Scene {
        columns: 2,
        rows: segments + 1,
        width: length / segments as f64,
        height: length,
        pins,
        pose,
        fabric,
        ..Scene::swing(segments + 1)
    }
}

/// Mean position of row `j` of a scene, m.
#[must_use]
pub fn row(scene: &Scene, specimen: &dyn Specimen, j: usize) -> DVec3 {
    let row = &specimen.positions()[j * scene.columns..(j + 1) * scene.columns];
    row.iter().map(|x| x.as_dvec3()).sum::<DVec3>() / scene.columns as f64
}

/// Masses of the first column of a strip from row 1 on, kg.
#[must_use]
pub fn column_masses(scene: &Scene) -> Vec<f64> {
    Grid::new(scene).masses.into_iter().step_by(scene.columns).skip(1).collect()
}

/// Length of a substep, s.
#[must_use]
pub fn substep(settings: StepSettings) -> f64 {
    1.0 / (f64::from(TICK_RATE) * f64::from(settings.substeps))
}

/// Scheme and substeps, for the names of cases.
#[must_use]
pub fn label(settings: StepSettings) -> String {
    let scheme = match settings.scheme {
        Scheme::GaussSeidel => "Gauss–Seidel",
        Scheme::Yarns => "yarns",
    };
    match settings.passes {
        1 => format!("{scheme} {}", settings.substeps),
        passes => format!("{scheme} {} × {passes}", settings.substeps),
    }
}

/// Case for the order of convergence that `errors` show, each at half the size of the one before.
#[must_use]
pub fn order(name: impl Into<String>, expected: f64, errors: &[f64]) -> Case {
    let halvings = errors.len() - 1;
    let observed = (errors[0] / errors[halvings]).abs().log2() / halvings as f64;
    Case::new(name, expected, observed, ORDER / expected)
}
