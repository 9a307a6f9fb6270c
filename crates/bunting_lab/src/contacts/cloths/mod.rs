//! Cloths that touch one another: pairs of triangles that intersect.

mod flags;
mod sleeves;
mod stack;
mod taut;
mod together;
mod vest;

use super::row::Row;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let mut rows = stack::rows();
    rows.push(flags::row(quick));
    rows.push(taut::row());
    rows.extend(vest::rows());
    rows.extend(sleeves::rows());
    rows
}
