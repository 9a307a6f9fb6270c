//! Batches, whose lanes hold the state of all simulated cloths, and the systems that step them.

pub mod assign;
pub mod batch_kind;
pub mod batches;
pub(crate) mod cost_kind;
pub mod group;
pub mod lane_handle;
pub mod occupancy;
pub(crate) mod parallel;
pub mod particles;
pub mod publish;
pub mod solve;
pub(crate) mod touching;
