//! Rays, nearest points and overlaps on the surfaces of cloths, for code without pointers and windows.

pub mod query;
pub(crate) mod surface;
