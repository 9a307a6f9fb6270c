//! Other engines on the same scenes, with the same particles and with constraints as similar as their
//! interfaces allow.

mod bunting;
pub mod engine;
pub mod measurement;
pub mod peer;
pub mod rapier;
