//! Cloth that touches itself: pairs of triangles that intersect.

mod cape;
mod flag;
mod fold;
mod layers;
mod towel;
mod watch;

use super::row::Row;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let mut rows = fold::rows();
    rows.extend(towel::rows(quick));
    rows.push(flag::row(quick));
    rows.push(cape::row(quick));
    rows
}
