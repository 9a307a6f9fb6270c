//! The gate: golden hashes, closed forms, hard cases, cloths at random and physical figures, compared with committed lists.

use std::{collections::BTreeSet, fs, path::Path};

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde_json::json;

use super::{
    differences::{Differences, known_failures},
    figures,
    gate_cases::{GateCase, Verdict},
    gate_jobs::{self, Measured},
};
use crate::{
    figure::Figure,
    golden::{self, GoldenHash},
    output::{Outcome, table::Table},
};

/// Options of the gate.
#[derive(Clone, Copy, Debug, Args)]
pub struct Options {
    /// Write the lists as they are measured, instead of comparing with them.
    #[arg(long)]
    write: bool,
    /// Only the golden hashes; the lists of known failures and of figures stay as they are.
    #[arg(long)]
    hashes: bool,
}

/// The committed list of cases that are known to fail, a line with the identity of each and its figure.
const KNOWN_FAILURES: &str = include_str!("../../expected/known_failures.txt");
/// Folder of the committed lists.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/expected");

/// Runs all cases and hashes and compares them with the committed lists.
///
/// # Errors
///
/// A result differs from the lists, and the differences have been presented; or the lists cannot be written.
pub fn run(options: Options, present: impl FnOnce(&Outcome) -> Result<()>) -> Result<()> {
    let measured = gate_jobs::measure(options.hashes);
    let Measured { cases, hashes, .. } = &measured;
    let figures = cases.as_ref().map(|cases| figures(cases, hashes));
    if options.write {
        return write(cases.as_deref(), figures.as_deref(), hashes);
    }
    let mut differences = Differences::default();
    if let (Some(cases), Some(figures)) = (cases, &figures) {
        differences.compare_cases(KNOWN_FAILURES, cases);
        differences.compare_figures(figures::EXPECTED, figures);
    }
    differences.compare_hashes(golden::EXPECTED, hashes);
    let known = match cases {
        Some(cases) => format!("{} of {} cases", KNOWN_FAILURES.lines().count(), cases.len()),
        None => format!("{} cases (none was run)", KNOWN_FAILURES.lines().count()),
    };
    present(&outcome(&differences, &measured, figures.as_deref().unwrap_or_default()))?;
    let count = differences.0.len();
    ensure!(count == 0, "{count} differences from the committed lists; {known} are known to fail");
    eprintln!("the gate holds; {known} are known to fail");
    Ok(())
}

/// Every figure that the committed file may watch.
fn figures(cases: &[GateCase], hashes: &[GoldenHash]) -> Vec<Figure> {
    let of_cases = cases.iter().filter_map(|case| case.figure.clone());
    let of_scenes = hashes.iter().flat_map(|hash| hash.figures.clone());
    of_cases.chain(of_scenes).collect()
}

fn outcome(differences: &Differences, measured: &Measured, figures: &[Figure]) -> Outcome {
    let table = Table {
        name: "gate".into(),
        title: format!("{} differences from the committed lists", differences.0.len()),
        headers: vec!["case", "difference"],
        rows: differences.0.iter().map(|row| row.to_vec()).collect(),
    };
    let values = figures.iter().map(|figure| json!([figure.name, figure.value]));
    let json = json!({
        "differences": differences.0,
        "cases": measured.cases.as_ref().map(Vec::len),
        "known_failures": KNOWN_FAILURES.lines().collect::<Vec<_>>(),
        "figures": values.collect::<Vec<_>>(),
    });
    Outcome { json, tables: vec![measured.times.clone(), table], plots: Vec::new() }
}

fn write(
    cases: Option<&[GateCase]>,
    figures: Option<&[Figure]>,
    hashes: &[GoldenHash],
) -> Result<()> {
    for hash in hashes {
        let deviations = hash.deviations.join("; ");
        ensure!(hash.deviations.is_empty(), "{} has no one hash: {deviations}", hash.scene);
    }
    write_list("golden_hashes.tsv", &golden::list(hashes))?;
    let (Some(cases), Some(figures)) = (cases, figures) else { return Ok(()) };
    write_list("known_failures.txt", &failing(KNOWN_FAILURES, cases))?;
    write_list("figures.tsv", &figures::list(figures::EXPECTED, figures)?)
}

/// The lines of the cases that fail, and of those of the list that are unclear.
fn failing(known: &str, cases: &[GateCase]) -> String {
    let known = known_failures(known);
    let fails = |case: &&GateCase| match case.verdict {
        Verdict::Passes => false,
        Verdict::Fails => true,
        Verdict::Unclear => known.contains_key(case.identity.as_str()),
    };
    let failing: BTreeSet<String> = cases.iter().filter(fails).map(GateCase::line).collect();
    failing.iter().map(|line| format!("{line}\n")).collect()
}

fn write_list(file: &str, list: &str) -> Result<()> {
    let path = Path::new(FOLDER).join(file);
    fs::write(&path, list).with_context(|| format!("cannot write {}", path.display()))
}
