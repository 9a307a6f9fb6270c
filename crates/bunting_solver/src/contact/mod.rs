//! Contacts between cloth and colliders.

mod candidates;
pub(crate) mod collider;
mod ground;
mod near;
mod solve;
mod surface;
