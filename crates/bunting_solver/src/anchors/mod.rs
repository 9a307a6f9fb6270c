//! What a cloth does to that which holds it.

pub(crate) mod pin_groups;
pub(crate) mod pin_reports;
mod sum_reactions;

pub use pin_groups::PinGroups;
pub use pin_reports::PinReaction;
