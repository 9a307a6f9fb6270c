//! Why a cloth cannot be put into a batch.

use crate::fabric::FabricError;

/// Why a cloth cannot be put into a batch.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// Every lane holds a cloth.
    #[error("all {lanes} lanes are occupied")]
    Full {
        /// Number of lanes.
        lanes: usize,
    },
    /// The state is of another fabric.
    #[error("the state has {given} particles, the fabric {expected}")]
    ParticleCount {
        /// Particles in the state.
        given: usize,
        /// Particles in the fabric.
        expected: usize,
    },
    /// The state is infinite or not a number.
    #[error("the state is not finite")]
    NotFinite,
    /// The material cannot be simulated.
    #[error(transparent)]
    Material(#[from] FabricError),
}
