//! Contacts between cloth and colliders.

mod candidates;
pub(crate) mod collider;
mod solve;
mod surface;
