//! Contacts between cloth and colliders.

mod bounds;
mod candidates;
pub(crate) mod collider;
mod ground;
pub(crate) mod lift;
mod near;
mod solve;
mod surface;
