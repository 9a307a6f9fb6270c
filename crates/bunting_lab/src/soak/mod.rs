//! Scenes that run for long: whether memory, times and motion stay what they were at their start.

pub mod churn;
mod memory;
pub mod part;
pub mod scenes;
