//! What acts on a cloth: wind, gravity, colliders.

pub mod collider;
pub mod drive;
pub mod gusts;
pub mod wind;
