//! Cloths at random: meshes, pins, materials, winds and jerks that no other case knows. What fails here becomes a row.

mod alone;
mod garments;
mod held;
mod meshes;
mod pieces;
mod rest;
mod sag;
mod trial;
mod verdicts;

pub use meshes::Family;
pub use rest::Rest;
pub use sag::Sag;
pub use trial::{Asked, Figures, Trial, of_seed};
pub use verdicts::{SEEDS, verdicts};
