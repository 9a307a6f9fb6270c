//! Closed forms against what the solver does.

use serde_json::json;

use super::progress;
use crate::{
    oracles::{Case, trials},
    output::{
        Outcome,
        table::{Table, figure},
    },
    product::Product,
};

/// Runs every trial.
#[must_use]
pub fn run() -> Outcome {
    let bar = progress(trials::ALL.len());
    let mut cases = Vec::new();
    for (name, trial) in trials::ALL {
        bar.set_message(name);
        cases.extend(trial(&|scene, settings| Box::new(Product::lone(settings).start(scene))));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Outcome { json: json!({ "cases": cases }), tables: vec![table(&cases)], plots: Vec::new() }
}

fn table(cases: &[Case]) -> Table {
    let passed = cases.iter().filter(|case| case.pass).count();
    Table {
        name: "oracles".into(),
        title: format!("{passed} of {} closed forms met", cases.len()),
        headers: vec!["case", "expected", "measured", "relative error", "tolerance", "pass"],
        rows: cases
            .iter()
            .map(|case| {
                vec![
                    case.name.clone(),
                    figure(case.expected),
                    figure(case.measured),
                    figure(case.relative_error),
                    figure(case.tolerance),
                    if case.pass { "yes" } else { "NO" }.into(),
                ]
            })
            .collect(),
    }
}
