//! Closed forms against what the solver does.

use serde_json::json;

use super::progress;
use crate::{
    oracles::{Case, trials},
    output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure},
        verdicts::{self, Verdict},
    },
    product::Product,
};

/// Runs every trial.
#[must_use]
pub fn run() -> Outcome {
    let cases = measure();
    let plots = [plot(&cases), cantilevers(&cases)].into_iter().flatten().collect();
    Outcome { json: json!({ "cases": cases }), tables: vec![table(&cases)], plots }
}

/// Names of the cases that fail.
#[must_use]
pub fn failing() -> Vec<String> {
    let failing = measure().into_iter().filter(|case| !case.pass);
    failing.map(|case| format!("oracles: {}", case.name)).collect()
}

fn measure() -> Vec<Case> {
    let bar = progress(trials::ALL.len());
    let mut cases = Vec::new();
    for (name, trial) in trials::ALL {
        bar.set_message(name);
        cases.extend(trial(&|scene, settings| Box::new(Product::lone(settings).start(scene))));
        bar.inc(1);
    }
    bar.finish_and_clear();
    cases
}

fn plot(cases: &[Case]) -> Option<Plot> {
    let verdicts: Vec<Verdict> = cases
        .iter()
        .map(|it| Verdict { worst: it.relative_error, limit: it.tolerance, pass: it.pass })
        .collect();
    let labels = ["tolerance", "relative error"];
    verdicts::plot("oracles", "Closed forms and what the cloth does", labels, &verdicts)
}

/// The drop of a heavy cantilever over its reach against Γ, as Romero et al. 2021 draw it.
fn cantilevers(cases: &[Case]) -> Option<Plot> {
    let drawn = cases.iter().filter_map(|case| Some((trials::gamma_of(case)?, case)));
    let (expected, measured): (Vec<_>, Vec<_>) =
        drawn.map(|(gamma, case)| ((gamma, case.expected), (gamma, case.measured))).unzip();
    let series = vec![
        Series { name: "elastica".into(), points: expected, mark: Mark::Guide },
        Series { name: "cloth".into(), points: measured, mark: Mark::Dots },
    ];
    (!series[0].points.is_empty()).then(|| Plot {
        name: "oracles_cantilever".into(),
        title: "A strip bends under its own weight".into(),
        labels: ["Γ = σgL³/B".into(), "drop over reach, H/W".into()],
        axes: Axes::Logarithmic,
        series,
    })
}

fn table(cases: &[Case]) -> Table {
    let passed = cases.iter().filter(|case| case.pass).count();
    Table {
        name: "oracles".into(),
        title: format!("{passed} of {} closed forms met", cases.len()),
        headers: vec!["case", "expected", "measured", "relative error", "tolerance", "pass"],
        // What fails first.
        rows: [false, true]
            .into_iter()
            .flat_map(|pass| cases.iter().filter(move |case| case.pass == pass))
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
