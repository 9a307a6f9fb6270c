//! Anchors, guides, wind with a place and forces of the user, in the plugin, compared with closed forms and with what their
//! documentation states.
//!
//! Every row is one figure and one limit.

mod anchors;
mod blast;
mod guides;
mod holds;
mod impossible;
mod impulse;
mod reactions;
mod turbulence;

use crate::contacts::Row;

/// Runs one family of rows; fewer and smaller where `quick`.
pub type Family = fn(quick: bool) -> Vec<Row>;

/// Every family with its name.
pub const ALL: [(&str, Family); 8] = [
    ("anchors", anchors::rows),
    ("guides", guides::rows),
    ("reactions", reactions::rows),
    ("holds", holds::rows),
    ("impulse", impulse::rows),
    ("turbulence", turbulence::rows),
    ("blast", blast::rows),
    ("impossible wind", impossible::rows),
];
