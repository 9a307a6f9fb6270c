//! What Häggström's thesis (2009) says in words about its time. Its figures 6.2 and B.1 are pictures
//! without numbers, and it does not say on which processor they were measured, nor how many vertices its
//! levels have.

/// Flags in the scene of figure 6.2.
pub const FLAGS: usize = 8;
/// Time of these flags at the finest level, ms (section 6.2: "approximately").
pub const FINEST_MS: f64 = 1.6;
/// The same at the coarsest level, ms.
pub const COARSEST_MS: f64 = 0.2;
/// Cost of damping all motion but the rigid one, which the thesis left out for it, of the time of a
/// frame (section 5.1).
pub const INTERNAL_DAMPING: f64 = 0.25;
