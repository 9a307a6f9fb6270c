//! Cloth that is stiff, taut or overdrawn: it must rest, sing in tune and bear its load.

mod bands;
mod curved;
mod membrane;
mod rests;
mod sail;

use super::case::HardCase;

/// Cases of bands that are held at both ends and of meshes of ordinary stiffness.
pub fn at_rest(_quick: bool) -> Vec<HardCase> {
    bands::cases().chain(curved::cases()).collect()
}

/// Cases of membranes and sails.
pub fn taut(_quick: bool) -> Vec<HardCase> {
    membrane::cases().chain(sail::cases()).collect()
}
