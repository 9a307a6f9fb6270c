//! What keeps a substep stable that is longer than the fastest vibration.

pub(crate) mod added_mass;
pub(crate) mod pin_strain;
pub(crate) mod pole;
pub(crate) mod relaxation;
