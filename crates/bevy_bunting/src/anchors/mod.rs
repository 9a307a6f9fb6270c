//! Springs and rails that hold a cloth, and what the cloth does to that which holds it.

mod breaking;
mod follow;
pub(crate) mod grab;
pub(crate) mod hold;
pub(crate) mod holds;
pub(crate) mod plugin;
pub(crate) mod reactions;
mod report;
