//! Trials: each closed form compared with a cloth.
//!
//! A tolerance is the known error of the discretisation plus the rounding of single precision; each constant
//! states its source.

mod buckling;
mod cantilever;
mod catenary;
mod drag;
mod fall;
mod meshes;
mod modes;
mod momentum;
mod pendulum;
mod spin;
mod stretch;

use super::Case;
use crate::specimen::Mount;

/// A family of cases of one closed form.
pub type Trial = fn(&Mount) -> Vec<Case>;

/// Every trial with its name.
pub const ALL: [(&str, Trial); 11] = [
    ("free fall", fall::cases),
    ("static stretch", stretch::cases),
    ("catenary", catenary::cases),
    ("cantilever", cantilever::cases),
    ("buckling", buckling::cases),
    ("hanging modes", modes::cases),
    ("stiff pendulum", pendulum::cases),
    ("drag", drag::cases),
    ("momentum", momentum::cases),
    ("spin", spin::cases),
    ("meshes", meshes::cases),
];

/// Cases of the trial with the given name.
///
/// # Panics
///
/// When there is no such trial.
#[must_use]
pub fn named(name: &str, mount: &Mount) -> Vec<Case> {
    let (_, trial) = ALL.iter().find(|(known, _)| *known == name).expect("a known trial");
    trial(mount)
}

/// Γ of a case of the cantilevers with the most links, parsed from its name.
#[must_use]
pub fn gamma_of(case: &Case) -> Option<f64> {
    cantilever::gamma_of(case)
}

/// Relative error of a cantilever that hardly bends, at Γ = 0.01, where H/W is Γ/8.
#[must_use]
pub fn stiffest_cantilever(mount: &Mount) -> f64 {
    cantilever::case(mount, 0.01, 32, super::rig::YARNS).relative_error
}

/// Whether a small perturbation of a narrow strip on edge, of `segments` links, grows under a fraction of the
/// load at which the strip should buckle.
#[must_use]
pub fn strip_on_edge_buckles(mount: &Mount, segments: usize, part: f64) -> bool {
    buckling::on_edge_grows(mount, segments, part)
}
