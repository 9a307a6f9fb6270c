//! Wind with a place and forces, compared with their documentation.

use serde_json::json;

use super::{
    contacts,
    families::{self, Family},
};
use crate::{contacts::Row, forces, output::Outcome};

/// Runs every family of forces.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let families = families(quick);
    let times = families::times("forces", &families);
    let rows: Vec<Row> = families.into_iter().flat_map(|family| family.cases).collect();
    let tables = vec![contacts::table("forces", &rows), times];
    Outcome { json: json!({ "rows": rows }), tables, plots: Vec::new() }
}

/// Every family with its rows.
#[must_use]
pub fn families(quick: bool) -> Vec<Family<Row>> {
    families::run(&forces::ALL, |family| family(quick))
}
