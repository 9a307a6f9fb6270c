//! Moving a cloth's state from one level of detail to another.
//!
//! To more particles (prolongation): a new particle takes its position and velocity from the coarse particles around
//! it, by a smooth stencil, so that folds are not flattened. To fewer (restriction): shared particles keep their
//! positions (thesis, 5.1.3), and velocities are gathered from all particles.
//!
//! The strain that either brings is then taken off the positions alone, the linear momentum is kept, and the total
//! energy does not grow: the motion about the mean velocity gives what strain and height have gained. The integrator
//! restarts at first order, since the new state has no history.

mod error;
mod grid;
mod interpolation;
mod level_transfer;
mod mesh;
mod motion;
mod settle;
#[cfg(test)]
mod tests;

pub use error::TransferError;
pub use level_transfer::LevelTransfer;
