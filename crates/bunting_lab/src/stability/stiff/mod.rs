//! Cloth that is stiff, taut or overdrawn: it must rest, sing in tune and bear its load.

mod bands;
mod curved;
mod membrane;
mod sail;

use super::case::HardCase;

/// Greatest speed of cloth at rest, m/s RMS. Motion is visible from 10 mm/s on.
const AT_REST: f64 = 1e-3;

/// Cases of bands that are held at both ends and of meshes of ordinary stiffness.
pub fn at_rest(_quick: bool) -> Vec<HardCase> {
    bands::cases().chain(curved::cases()).collect()
}

/// Cases of membranes and sails.
pub fn taut(_quick: bool) -> Vec<HardCase> {
    membrane::cases().chain(sail::cases()).collect()
}

/// Case of the greatest RMS speed in the last second of a run.
fn rests(name: impl Into<String>, n: usize, speed: f64) -> HardCase {
    HardCase::new(format!("{}: at rest", name.into()), n, "RMS speed, m/s", speed, AT_REST)
}
