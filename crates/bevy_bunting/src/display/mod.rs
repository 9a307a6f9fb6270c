//! The displayed surface: interpolated between two ticks, and eased across changes of level.

pub mod decay;
pub mod ease;
pub mod easing;
pub mod lift;
pub mod lifting;
pub mod surface;
