//! How alike the levels of detail are, and what changing between them does.

pub mod agreement;
pub mod pops;
pub mod resolution;
pub mod switches;
