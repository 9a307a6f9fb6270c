//! Agreement of the levels of detail, and the effects of changes between them.

pub mod agreement;
pub mod pops;
pub mod resolution;
pub mod switches;

/// Flags flown at once, each in different gusts.
const FLAGS: usize = 8;
/// Time that flags fly before the first observation, s.
const SETTLING: f64 = 3.0;
/// Time between observations, s; no fraction of a gust's period.
const INTERVAL: f64 = 0.37;
