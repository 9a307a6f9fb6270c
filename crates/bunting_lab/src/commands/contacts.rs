//! Contacts compared with closed forms.

use serde_json::json;

use super::families::{self, Family};
use crate::{
    contacts::{self, Row},
    output::{
        Outcome,
        table::{Table, figure, figure_or_dash},
    },
};

/// Runs every family of contacts.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let families = families(quick);
    let times = families::times("contacts", &families);
    let rows: Vec<Row> = families.into_iter().flat_map(|family| family.cases).collect();
    Outcome {
        json: json!({ "rows": rows }),
        tables: vec![table("contacts", &rows), times],
        plots: Vec::new(),
    }
}

/// Every family with its rows.
#[must_use]
pub fn families(quick: bool) -> Vec<Family<Row>> {
    families::run(&contacts::ALL, |family| family(quick))
}

/// Table of the rows of a command.
pub(super) fn table(command: &str, rows: &[Row]) -> Table {
    let passed = rows.iter().filter(|row| row.pass).count();
    let cells = |row: &Row| {
        vec![
            row.name.clone(),
            row.quantity.into(),
            figure_or_dash(row.figure),
            figure(row.limit),
            if row.pass { "yes" } else { "NO" }.into(),
            figure(row.us),
        ]
    };
    Table {
        name: command.into(),
        title: format!("{passed} of {} rows of {command} hold", rows.len()),
        headers: vec!["row", "figure", "worst", "limit", "pass", "µs a tick"],
        rows: rows.iter().map(cells).collect(),
    }
}
