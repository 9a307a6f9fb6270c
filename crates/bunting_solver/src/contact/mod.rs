//! What a cloth may touch.

pub(crate) mod collider;
mod solve;
