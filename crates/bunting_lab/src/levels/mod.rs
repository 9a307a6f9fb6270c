//! How alike the levels of detail are, and what changing between them does.

pub mod agreement;
pub mod pops;
pub mod resolution;
pub mod switches;

/// Flags flown at once, each in other gusts.
const FLAGS: usize = 8;
/// Time that flags fly before the first look, s.
const SETTLING: f64 = 3.0;
/// Time between looks, s; no part of a gust's period.
const INTERVAL: f64 = 0.37;
