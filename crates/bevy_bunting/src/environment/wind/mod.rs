//! Wind: the velocity of the air, everywhere or where its sources are.

pub mod blast;
pub mod fan;
pub mod field;
mod gusts;
pub mod influence;
pub mod per_particle;
pub(crate) mod places;
pub mod plugin;
pub mod region;
mod report;
mod shift;
pub mod tick_wind;
pub mod wake;
