//! Transfer of a cloth's state from one level of detail to another.
//!
//! Prolongation, to more particles: a new particle takes its position and velocity from the coarse particles
//! around it, by a smooth stencil, so that folds are not flattened. Restriction, to fewer particles: shared
//! particles keep their positions (thesis, 5.1.3), and velocities are gathered from all particles.
//!
//! The strain that a transfer brings is then removed from the positions alone, the linear momentum is
//! conserved, and the total energy does not grow: any gain of strain energy and height is taken from the
//! motion about the mean velocity. The integrator restarts at first order, since the new state has no
//! history.

mod error;
mod grid;
mod interpolation;
mod level_transfer;
mod mesh;
mod motion;
mod relax;
mod settle;
#[cfg(test)]
mod tests;

pub use error::TransferError;
pub use level_transfer::LevelTransfer;
