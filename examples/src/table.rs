//! Tables on the terminal.

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{Cell, CellAlignment, Table};

/// A table with a header and rows; all columns but the first are aligned to the right.
pub fn table<Row>(
    header: impl IntoIterator<Item = impl Into<Cell>>,
    rows: impl IntoIterator<Item = Row>,
) -> Table
where
    Row: IntoIterator<Item: Into<Cell>>,
{
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_header(cells(header));
    for row in rows {
        table.add_row(cells(row));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn cells(row: impl IntoIterator<Item = impl Into<Cell>>) -> Vec<Cell> {
    row.into_iter().map(Into::into).collect()
}
