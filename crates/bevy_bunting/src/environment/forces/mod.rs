//! Forces of the user: impulses, accelerations, and control over single particles.

pub mod acceleration;
pub mod control;
pub mod impulse;
pub mod plugin;
