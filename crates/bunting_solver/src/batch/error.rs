//! Errors of batches.

use crate::fabric::FabricError;

/// Reason why a cloth cannot be put into a batch, or changed in it.
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
    /// The cloth's fabric is not that of the batch, or not of its topology where the batch is mixed.
    #[error("the cloth's fabric is not one of the batch's")]
    Fabric,
    /// The state is infinite or not a number.
    #[error("the state is not finite")]
    NotFinite,
    /// There is no such lane.
    #[error("there is no lane {lane}: there are {lanes}")]
    NoLane {
        /// The lane.
        lane: usize,
        /// Number of lanes.
        lanes: usize,
    },
    /// A number of the drive is infinite or not a number, or the air's density is negative.
    #[error("the drive's {name} is not finite, or negative where it cannot be")]
    Drive {
        /// The field's name.
        name: &'static str,
    },
    /// A pin to be moved is not pinned, or one of its positions is infinite or not a number.
    #[error("particle {particle} is not pinned, or its way is not finite")]
    Pin {
        /// Index of the particle.
        particle: u32,
    },
    /// A number of a guide is infinite or not a number, or a distance is negative.
    #[error("the guide of particle {particle} is not finite, or has a negative distance or radius")]
    Guide {
        /// Index of the particle.
        particle: u32,
    },
    /// A number of a hold is infinite or not a number, or negative, or its rail has no points.
    #[error(
        "the place, stiffness, mass or friction of the hold of particle {particle} is not finite, or negative"
    )]
    Hold {
        /// Index of the particle.
        particle: u32,
    },
    /// A stitch names a particle that the fabric does not have, sews a particle to itself, or its part is not within 0 to 1.
    #[error(
        "stitch {stitch} needs particles of the fabric, two different sides, and a part from 0 to 1"
    )]
    Stitch {
        /// Index of the stitch in the given list.
        stitch: usize,
    },
    /// A length or a time of a lacing is infinite or not a number, or negative.
    #[error("the length or the time of lacing {lacing} is not finite, or negative")]
    Lacing {
        /// Index of the lacing in the given list.
        lacing: usize,
    },
    /// A number of a collider is infinite or not a number.
    #[error("the pose, margin or friction of collider {index} is not finite")]
    Collider {
        /// Index of the collider in the given list.
        index: usize,
    },
    /// A number of a pressure is infinite or not a number, or negative where it cannot be.
    #[error("the {name} of the pressure is not finite, or negative where it cannot be")]
    Pressure {
        /// What the number is.
        name: &'static str,
    },
    /// The air of an open cloth cannot be sealed.
    #[error(
        "air cannot be sealed in a cloth whose holes have an area of {area} m²: close its mesh, or give it a constant pressure"
    )]
    Open {
        /// Area of the holes, as a vector's length, m².
        area: f32,
    },
    /// The thickness of a self-collision is not finite, or not greater than zero.
    #[error("the thickness of the self-collision must be finite and greater than zero")]
    SelfCollision,
    /// The material cannot be simulated.
    #[error(transparent)]
    Material(#[from] FabricError),
}
