//! Batches, whose lanes hold the state of all simulated cloths, and the systems that step them.

pub mod assign;
pub mod batch_kind;
pub mod batches;
mod choose_substeps;
pub(crate) mod cost_kind;
pub mod group;
mod kinds;
pub mod lane_handle;
pub mod occupancy;
pub(crate) mod parallel;
pub mod particles;
pub mod publish;
pub(crate) mod shared_substeps;
pub mod solve;
mod spare;
pub(crate) mod touching;
