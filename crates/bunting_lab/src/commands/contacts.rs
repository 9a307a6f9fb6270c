//! Contacts compared with closed forms.

use anyhow::Result;
use serde_json::json;

use super::families::{self, Selection};
use crate::{
    contacts::{self, Row},
    output::{
        Outcome,
        table::{Table, figure, figure_or_dash},
    },
};

/// Runs the selected families of contacts.
///
/// # Errors
///
/// A selected family does not exist.
pub fn run(selection: &Selection, quick: bool) -> Result<Outcome> {
    let families = families::run(&selection.of(&contacts::ALL)?, |family| family(quick));
    let times = families::times("contacts", &families);
    let rows: Vec<Row> = families.into_iter().flat_map(|family| family.cases).collect();
    let outcome = Outcome {
        json: json!({ "rows": rows }),
        tables: vec![table("contacts", &rows), times],
        plots: Vec::new(),
    };
    Ok(with_peers(outcome, quick))
}

/// Adds the drapes of this project and of rapier.
#[cfg(feature = "peers")]
fn with_peers(mut outcome: Outcome, quick: bool) -> Outcome {
    let drapes = contacts::beside::drapes(quick);
    outcome.json["drapes"] = json!(drapes);
    let cells = |it: &contacts::beside::Drape| {
        vec![
            it.shape.into(),
            it.engine.into(),
            it.substeps.to_string(),
            figure(it.depth_m),
            figure_or_dash(it.speed),
            figure_or_dash(it.mean_strain),
            figure(it.us),
        ]
    };
    outcome.tables.push(Table {
        name: "drapes".into(),
        title: "Sheets of 33 × 33 that fall on a shape, after 4 s".into(),
        headers: vec![
            "shape",
            "engine",
            "substeps",
            "highest above the cloth, m",
            "RMS speed m/s",
            "mean strain",
            "µs a tick",
        ],
        rows: drapes.iter().map(cells).collect(),
    });
    outcome
}

#[cfg(not(feature = "peers"))]
fn with_peers(outcome: Outcome, _quick: bool) -> Outcome {
    outcome
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
