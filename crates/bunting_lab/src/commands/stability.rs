//! The hard cases.

use anyhow::Result;
use serde_json::json;

use super::families::{self, Selection};
use crate::{
    output::{
        Outcome,
        plot::Plot,
        table::{Table, figure, figure_or_dash},
        verdicts::{self, Verdict},
    },
    stability::{self, HardCase, Status},
};

/// Runs the selected families of hard cases.
///
/// # Errors
///
/// A selected family does not exist.
pub fn run(selection: &Selection, quick: bool) -> Result<Outcome> {
    let families = families::run(&selection.of(&stability::ALL)?, |family| family(quick));
    let times = families::times("stability", &families);
    let families_json = families::json(&families);
    let cases: Vec<HardCase> = families.into_iter().flat_map(|family| family.cases).collect();
    let plots = plot(&cases).into_iter().collect();
    Ok(Outcome {
        json: json!({ "cases": cases, "families": families_json }),
        tables: vec![table(&cases), times],
        plots,
    })
}

fn plot(cases: &[HardCase]) -> Option<Plot> {
    let built = cases.iter().filter(|case| case.status == Status::Built);
    let verdicts: Vec<Verdict> = built
        .map(|it| Verdict { worst: it.worst.unwrap_or(f64::NAN), limit: it.limit, pass: it.pass })
        .collect();
    verdicts::plot("stability", "Hard cases", ["limit", "worst figure"], &verdicts)
}

fn table(cases: &[HardCase]) -> Table {
    let built = cases.iter().filter(|case| case.status == Status::Built).count();
    let passed = cases.iter().filter(|case| case.pass).count();
    Table {
        name: "stability".into(),
        title: format!("{passed} of {built} hard cases held, {} not built", cases.len() - built),
        headers: vec!["case", "n", "figure", "worst", "limit", "pass"],
        // Failing cases first.
        rows: [false, true]
            .into_iter()
            .flat_map(|pass| cases.iter().filter(move |case| case.pass == pass))
            .map(cells)
            .collect(),
    }
}

fn cells(case: &HardCase) -> Vec<String> {
    let verdict = match (case.status, case.pass) {
        (Status::NotBuilt, _) => "not built",
        (Status::Built, true) => "yes",
        (Status::Built, false) => "NO",
    };
    vec![
        case.name.clone(),
        if case.n == 0 { "–".into() } else { case.n.to_string() },
        case.figure.into(),
        figure_or_dash(case.worst),
        figure(case.limit),
        verdict.into(),
    ]
}
