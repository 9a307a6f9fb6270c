//! The scenes of the examples, one folder each.

pub mod cape;
#[cfg(feature = "avian")]
pub mod convoy;
pub mod crowd;
pub mod curtain;
pub mod custom_constraint;
pub mod drape;
pub mod flags;
pub mod parasol;
#[cfg(feature = "avian")]
pub mod rollback;
pub mod storm;
pub mod swatches;
pub mod towel;
pub mod wardrobe;
