//! Tests of scene files and what they spawn, in one binary.

mod load;
mod spawn;
mod track;
