//! Regions of a cloth in which its material differs, such as hems and battens.
//!
//! `region` says where and by what factors, `coverage` how far a region covers each particle's part of the cloth, and `variation` keeps
//! what follows: factors for each particle, which links, bend lines and masses take over when a fabric is built. Kernels know nothing
//! of it.

mod coverage;
mod factors;
mod ground;
mod kites;
mod region;
mod region_error;
mod variation;

pub(super) use ground::Ground;
pub(crate) use variation::Extremes;
pub(super) use variation::Variation;

pub use region::{MaterialRegion, RegionShape};
pub use region_error::RegionError;
