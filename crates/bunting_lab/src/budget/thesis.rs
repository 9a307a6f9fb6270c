//! Times that Häggström's thesis (2009) states in words. Its figures 6.2 and B.1 are pictures without
//! numbers, and it names neither the processor nor the number of vertices of its levels.

/// Flags in the scene of figure 6.2.
pub const FLAGS: usize = 8;
/// Time of these flags at the finest level, ms (section 6.2: "approximately").
pub const FINEST_MS: f64 = 1.6;
/// Time of these flags at the coarsest level, ms.
pub const COARSEST_MS: f64 = 0.2;
/// Cost of damping all motion except the rigid one, as a fraction of a frame's time; the thesis left this
/// damping out because of its cost (section 5.1).
pub const INTERNAL_DAMPING: f64 = 0.25;
