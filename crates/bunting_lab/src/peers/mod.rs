//! Other engines on the same scenes, with the same particles and as nearly the same constraints as
//! their interfaces allow.

mod bunting;
pub mod engine;
pub mod measurement;
pub mod peer;
pub mod rapier;
