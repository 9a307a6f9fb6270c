//! Wind, gravity and colliders: everything that acts on a cloth besides its attachment.

pub mod collider;
pub mod drive;
pub mod gusts;
pub mod wind;
