//! One substep: from forces to predicted positions, and from corrected positions to velocities.

pub(crate) mod air;
pub(crate) mod bdf;
mod begin;
pub(crate) mod carry;
pub(crate) mod clock;
mod damping;
pub(crate) mod effort;
pub(crate) mod effort_class;
pub(crate) mod frame;
pub(crate) mod guides;
mod integrate;
pub(crate) mod limits;
pub(crate) mod load_stretch;
pub(crate) mod loads;
mod local_air;
pub(crate) mod local_wind;
mod move_guides;
mod move_pins;
pub(crate) mod moving_pins;
pub(crate) mod parameters;
pub(crate) mod predict;
pub(crate) mod rigid_motion;
mod settings;
mod velocity;

pub use guides::{Backstop, Guide};
pub use moving_pins::MovingPin;
pub use settings::{Drive, Scheme, StepSettings};
