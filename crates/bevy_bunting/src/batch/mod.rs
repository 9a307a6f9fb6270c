//! Batches, in whose lanes the state of all cloths lives, and the systems that step them.

pub mod assign;
pub mod batches;
pub mod occupancy;
pub mod publish;
pub mod solve;
