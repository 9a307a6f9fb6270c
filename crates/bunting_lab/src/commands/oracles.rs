//! Closed forms compared with the solver.

use anyhow::Result;
use serde_json::json;

use super::families::{self, Selection};
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

/// Runs the trials of the selected families.
///
/// # Errors
///
/// A selected family does not exist.
pub fn run(selection: &Selection) -> Result<Outcome> {
    let families = families::run(&selection.of(&trials::ALL)?, |trial| {
        trial(&|scene, settings| Box::new(Product::lone(settings).start(scene)))
    });
    let times = families::times("oracles", &families);
    let families_json = families::json(&families);
    let cases: Vec<Case> = families.into_iter().flat_map(|family| family.cases).collect();
    let plots = [plot(&cases), cantilevers(&cases)].into_iter().flatten().collect();
    Ok(Outcome {
        json: json!({ "cases": cases, "families": families_json }),
        tables: vec![table(&cases), times],
        plots,
    })
}

fn plot(cases: &[Case]) -> Option<Plot> {
    let verdicts: Vec<Verdict> = cases
        .iter()
        .map(|it| Verdict { worst: it.relative_error, limit: it.tolerance, pass: it.pass })
        .collect();
    let labels = ["tolerance", "relative error"];
    verdicts::plot("oracles", "Closed forms and what the cloth does", labels, &verdicts)
}

/// Drop of a heavy cantilever over its reach against Γ, as drawn by Romero et al. 2021.
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
        // Failing cases first.
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
