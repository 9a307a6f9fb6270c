//! Seams: edges of a cloth that are sewn to edges of the same cloth.
//!
//! A stitch holds a particle on a point between two others. Lines end at seams, and a line that is solved without the one behind the
//! seam hands on only as much of its load as two single particles can: a panel of thirty rows that hangs from another one would sink by
//! its thirtieth part of a link in each pass. Therefore a stitch is solved at once with the lines that end there (`line.rs`, `solve.rs`),
//! once in a substep: after each pass it would take three times as long, and panels hang as exactly. Then all stitches are closed
//! exactly, by their own particles alone.

pub(crate) mod closing;
mod lane;
mod line;
mod link_place;
mod link_places;
pub(crate) mod plan;
mod solve;
pub(crate) mod state;
pub(crate) mod stitch;
