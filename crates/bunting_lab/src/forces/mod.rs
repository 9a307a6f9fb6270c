//! Wind with a place and forces of the user, in the plugin, compared with what their documentation states.
//!
//! Every row is one figure and one limit.

mod blast;
mod impossible;
mod impulse;
mod turbulence;

use crate::contacts::Row;

/// Runs one family of rows; fewer and smaller where `quick`.
pub type Family = fn(quick: bool) -> Vec<Row>;

/// Every family with its name.
pub const ALL: [(&str, Family); 4] = [
    ("impulse", impulse::rows),
    ("turbulence", turbulence::rows),
    ("blast", blast::rows),
    ("impossible wind", impossible::rows),
];
