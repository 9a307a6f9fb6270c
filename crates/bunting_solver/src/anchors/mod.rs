//! That which holds a cloth from outside, and what the cloth does to it.

pub(crate) mod hold;
pub(crate) mod holds;
pub(crate) mod pin_groups;
pub(crate) mod pin_reports;
mod solve_holds;
mod sum_reactions;

pub use hold::{Hold, Holder};
pub use pin_groups::PinGroups;
pub use pin_reports::PinReaction;
