//! Wind with a place and forces, compared with their documentation.

use anyhow::Result;
use serde_json::json;

use super::{
    contacts,
    families::{self, Selection},
};
use crate::{contacts::Row, forces, output::Outcome};

/// Runs the selected families of forces.
///
/// # Errors
///
/// A selected family does not exist.
pub fn run(selection: &Selection, quick: bool) -> Result<Outcome> {
    let families = families::run(&selection.of(&forces::ALL)?, |family| family(quick));
    let times = families::times("forces", &families);
    let rows: Vec<Row> = families.into_iter().flat_map(|family| family.cases).collect();
    let tables = vec![contacts::table("forces", &rows), times];
    Ok(Outcome { json: json!({ "rows": rows }), tables, plots: Vec::new() })
}
