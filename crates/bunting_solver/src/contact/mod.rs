//! What a cloth may touch.

pub(crate) mod collider;
mod ground;
mod near;
mod solve;
