//! Cloths that touch one another: pairs of triangles that intersect.

mod flags;
mod stack;
mod taut;
mod together;

use super::row::Row;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let mut rows = stack::rows();
    rows.push(flags::row(quick));
    rows.push(taut::row());
    rows
}
