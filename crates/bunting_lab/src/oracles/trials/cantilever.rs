//! A strip clamped horizontally that bends under its own weight.

use bunting_solver::StepSettings;

use crate::{
    oracles::{
        Case,
        bending::Cantilever,
        rig::{YARNS, label, order, row, strip},
    },
    scenes::{Fabric, GRAVITY, Pins, Pose, Scene, ticks},
    simulation::run,
    specimen::{Mount, Specimen},
};

/// Γ = σgL³/B, as tabulated by Romero et al. 2021.
const GAMMAS: [f64; 11] = [0.1, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
/// Links along the free length.
const SEGMENTS: usize = 32;
/// The Γ at which the order is observed.
const OBSERVED: f64 = 10.0;
/// Time in which the load grows, and again time to come to rest, s.
const LOADING: f64 = 10.0;
/// Damping, 1/s.
const DAMPING: f64 = 4.0;
/// Error of the three-point stencil at Γ = 10, times N². The double-precision reference, relaxed to rest, has
/// errors of 2.7, 0.73 and 0.20 % at N = 8, 16 and 32. The error grows in proportion to Γ as the fold
/// narrows, and is constant where the strip is nearly straight.
const STENCIL: f64 = 2.1;
/// Factor on the stencil's error within which a case passes.
const MARGIN: f64 = 1.5;
/// Bending stiffness of a strip of one cell that bends at hinges, as a part of the material's. Bent to a cylinder it
/// finds wrinkles of one cell, since its diagonals alternate: the least energy of hinges over a period of two cells is
/// 4/5 of that of the cylinder (5/6 in a wide sheet).
const HINGED: f64 = 0.8;

/// Cases of the strip's shape H/W for every Γ, and of the order at which it approaches the continuum.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases: Vec<Case> =
        GAMMAS.into_iter().map(|gamma| case(mount, gamma, SEGMENTS, YARNS)).collect();
    let sizes = [8, 16, 32].map(|segments| case(mount, OBSERVED, segments, YARNS));
    let errors = sizes.each_ref().map(|case| case.measured - case.expected);
    cases.extend(sizes.into_iter().take(2));
    cases.push(order(
        format!("cantilever, Γ = {OBSERVED}, order in N, {}", label(YARNS)),
        2.0,
        &errors,
    ));
    cases.push(hinged(mount, 8, StepSettings::gauss_seidel(50)));
    cases
}

/// Case of a strip that bends at hinges, as in Gauss–Seidel's scheme. It is as soft as is expected of hinges: the
/// closed form is that of a strip of their stiffness.
fn hinged(mount: &Mount, segments: usize, settings: StepSettings) -> Case {
    let gamma = OBSERVED / HINGED;
    Case::new(
        format!(
            "cantilever, Γ = {OBSERVED}, N = {segments}, {}, hinges of {HINGED} of the stiffness",
            label(settings)
        ),
        Cantilever::new(gamma).aspect(),
        aspect(mount, OBSERVED, segments, settings),
        tolerance(gamma, segments),
    )
}

/// Relative error of the stencil, with a margin.
fn tolerance(gamma: f64, segments: usize) -> f64 {
    let stencil = STENCIL * 0.5 * (1.0 + gamma / OBSERVED) / (segments * segments) as f64;
    MARGIN * stencil
}

/// Γ of the finest strip's cases.
pub fn gamma_of(case: &Case) -> Option<f64> {
    let (gamma, rest) = case.name.strip_prefix("cantilever, Γ = ")?.split_once(", ")?;
    rest.starts_with(&format!("N = {SEGMENTS},")).then(|| gamma.parse().ok())?
}

/// The case of one Γ.
pub fn case(mount: &Mount, gamma: f64, segments: usize, settings: StepSettings) -> Case {
    Case::new(
        format!("cantilever, Γ = {gamma}, N = {segments}, {}", label(settings)),
        Cantilever::new(gamma).aspect(),
        aspect(mount, gamma, segments, settings),
        tolerance(gamma, segments),
    )
}

/// Drop of the tip over its reach. One metre of the strip is free, and one more cell lies in the clamp.
fn aspect(mount: &Mount, gamma: f64, segments: usize, settings: StepSettings) -> f64 {
    let fabric = Fabric { bending: Fabric::STANDARD.density * GRAVITY / gamma, ..Fabric::STANDARD };
    let length = 1.0 + 1.0 / segments as f64;
    let strip = strip(segments + 1, length, Pins::TopClamp, Pose::Horizontal, fabric);
    let scene = Scene { damping: DAMPING, ..strip };
    let mut specimen = mount(&scene, settings);
    load_slowly(specimen.as_mut());
    run(specimen.as_mut(), LOADING);
    let reach = row(&scene, specimen.as_ref(), segments + 1) - row(&scene, specimen.as_ref(), 1);
    -reach.y / reach.z
}

/// Raises gravity slowly from zero, since other equilibria exist.
fn load_slowly(specimen: &mut dyn Specimen) {
    let last = ticks(LOADING);
    for tick in 1..=last {
        specimen.load(GRAVITY * tick as f64 / last as f64);
        specimen.tick();
    }
}
