//! Measures that keep substeps stable although they are longer than the period of the fastest vibration.

pub(crate) mod added_mass;
pub(crate) mod disturbance;
pub(crate) mod pin_strain;
pub(crate) mod pole;
pub(crate) mod relaxation;
pub(crate) mod spin;
