//! Strips that stretch under their own weight.

use bunting_solver::StepSettings;

use crate::{
    oracles::{
        Case,
        rig::{GAUSS_SEIDEL, YARNS, chains, label, row, strip, substep},
        stretch::hung_strip,
    },
    scenes::{Fabric, GRAVITY, Pins, Pose, Scene},
    simulation::run,
    specimen::Mount,
};

/// Time to come to rest, s: at 5/s the oscillation is down to e⁻²⁰.
const SETTLING: f64 = 8.0;
/// Damping, 1/s.
const DAMPING: f64 = 5.0;
/// Unit in the last place of a length just below a metre, m.
const ULP: f64 = 6e-8;
/// Stiffness of a strip that stretches by 0.1 %, N/m: rounding is small compared with this stretch.
const SOFT: f64 = 1e3;
/// Stiffness of a strip that stretches by 1 %, N/m, as knitted cloth does.
const ELASTIC: f64 = 100.0;

/// Fabrics measured by Wang et al. 2011: σ in kg/m², stretch along warp and weft and shear in N/m.
const FABRICS: [(&str, f64, [f64; 2], f64); 5] = [
    ("polyester tablecloth", 0.128, [2002.0, 2027.0], 19.0),
    ("polyester jacket", 0.113, [43.0, 171.0], 14.0),
    ("cotton-polyester tee", 0.187, [17.0, 34.0], 37.0),
    ("cotton denim", 0.324, [205.0, 1014.0], 53.0),
    ("nylon/spandex", 0.204, [48.0, 105.0], 61.0),
];

/// Cases of δ/L = σgL/2Y at every resolution, for every fabric.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for segments in [8, 16, 32, 64] {
        // The strain is exact at every resolution, except for rounding.
        cases.push(soft(mount, segments, SOFT, YARNS, 0.0));
    }
    cases.push(soft(mount, 32, ELASTIC, YARNS, 0.0));
    for segments in [8, 16] {
        // One sweep in a substep of length h has a numerical compliance of h²/m for each link: the strain
        // grows by g h² N²/2L.
        let steps = substep(GAUSS_SEIDEL) * segments as f64;
        let hidden = steps * steps * ELASTIC / Fabric::STANDARD.density;
        cases.push(soft(mount, segments, ELASTIC, GAUSS_SEIDEL, hidden));
    }
    for segments in [8, 16] {
        let fabric = Fabric::STANDARD;
        cases.push(sheared(mount, "standard fabric", segments, fabric));
    }
    for (name, density, stretch, shear) in FABRICS {
        cases.push(sheared(mount, name, 16, Fabric { density, stretch, shear, bending: 0.0 }));
    }
    cases
}

/// Case of a strip of chains, whose stretch is exact.
fn soft(
    mount: &Mount,
    segments: usize,
    stiffness: f64,
    settings: StepSettings,
    hidden: f64,
) -> Case {
    let fabric = chains(stiffness);
    let expected = hung_strip(fabric.density, GRAVITY, 1.0, stiffness);
    Case::new(
        format!("stretch, Y = {stiffness} N/m, N = {segments}, {}", label(settings)),
        expected,
        stretch(mount, segments, fabric, settings),
        rounding(segments, expected, settings) + hidden,
    )
}

/// Case of a strip with diagonals. They are linear only for small strain: the error is of the order of the
/// largest strain.
fn sheared(mount: &Mount, name: &str, segments: usize, fabric: Fabric) -> Case {
    let expected = hung_strip(fabric.density, GRAVITY, 1.0, fabric.stretch[1]);
    Case::new(
        format!("stretch, {name}, N = {segments}, {}", label(YARNS)),
        expected,
        stretch(mount, segments, fabric, YARNS),
        2.0 * expected + rounding(segments, expected, YARNS),
    )
}

/// Error of a stretch by single precision: each row is off by a unit in the last place, and within the
/// effective step of 2h/3 a force of less than ulp/(2h/3)² is lost.
fn rounding(segments: usize, expected: f64, settings: StepSettings) -> f64 {
    let step = 2.0 / 3.0 * substep(settings);
    segments as f64 * ULP / expected + ULP / (GRAVITY * step * step)
}

/// Measured δ/L.
fn stretch(mount: &Mount, segments: usize, fabric: Fabric, settings: StepSettings) -> f64 {
    let strip = strip(segments, 1.0, Pins::Top, Pose::Vertical, fabric);
    let scene = Scene { damping: DAMPING, ..strip };
    let mut specimen = mount(&scene, settings);
    run(specimen.as_mut(), SETTLING);
    -row(&scene, specimen.as_ref(), segments).y - 1.0
}
