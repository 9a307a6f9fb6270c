//! What a cloth does to that which holds it.

pub(crate) mod plugin;
pub(crate) mod reactions;
mod report;
