//! The surface that is shown: between two ticks, and across changes of level.

pub mod easing;
pub mod surface;
