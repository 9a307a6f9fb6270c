//! The costs of cloth: many flags at once, the phases of a tick, single kernels, and a field of a thousand
//! flags with levels of detail.

pub mod different;
pub mod distance;
pub mod kernels;
pub mod many_flags;
pub mod parts;
pub mod phases;
pub mod plots;
pub mod spawning;
pub mod tables;
pub mod thesis;
pub mod thousand;
