//! Contacts between cloth and colliders.

mod bounds;
pub(crate) mod candidates;
pub(crate) mod cloths;
pub(crate) mod collider;
mod drawn_out;
mod gather;
mod ground;
pub(crate) mod itself;
pub(crate) mod lift;
mod near;
mod nearest;
mod obstacle;
pub(crate) mod points;
pub(crate) mod pressing;
mod reach;
pub(crate) mod reaction;
mod solve;
mod starts;
mod surface;
mod sweep;
mod swept_boxes;
mod touch;
