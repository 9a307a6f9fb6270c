//! The gate: golden hashes, closed forms and hard cases, compared with committed lists.

use std::{fs, path::Path, time::Instant};

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde_json::json;

use super::{
    contacts,
    differences::{Differences, GateCase},
    families, forces, oracles, stability,
};
use crate::{
    golden::{self, GoldenHash},
    output::{Outcome, table::Table},
    stability::Status,
};

/// Options of the gate.
#[derive(Clone, Copy, Debug, Args)]
pub struct Options {
    /// Write the lists as they are measured, instead of comparing with them.
    #[arg(long)]
    write: bool,
    /// Only the golden hashes; the list of known failures stays as it is.
    #[arg(long)]
    hashes: bool,
}

/// The committed list of cases that are known to fail, one identity a line.
const KNOWN_FAILURES: &str = include_str!("../../expected/known_failures.txt");
/// Folder of the committed lists.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/expected");

/// Runs all cases and hashes and compares them with the committed lists.
///
/// # Errors
///
/// A result differs from the lists, and the differences have been presented; or the lists cannot be written.
pub fn run(options: Options, present: impl FnOnce(&Outcome) -> Result<()>) -> Result<()> {
    let mut times = Vec::new();
    let cases = (!options.hashes).then(|| measure_cases(&mut times));
    let start = Instant::now();
    let hashes = golden::measure();
    eprintln!("golden hashes: {:.1} s", start.elapsed().as_secs_f64());
    if options.write {
        return write(cases.as_deref(), &hashes);
    }
    let mut differences = Differences::default();
    if let Some(cases) = &cases {
        differences.compare_cases(KNOWN_FAILURES, cases);
    }
    differences.compare_hashes(golden::EXPECTED, &hashes);
    present(&outcome(&differences, cases.as_deref(), times))?;
    let known = match &cases {
        Some(cases) => format!("{} of {} cases", KNOWN_FAILURES.lines().count(), cases.len()),
        None => format!("{} cases (none was run)", KNOWN_FAILURES.lines().count()),
    };
    let count = differences.0.len();
    ensure!(count == 0, "{count} differences from the committed lists; {known} are known to fail");
    eprintln!("the gate holds; {known} are known to fail");
    Ok(())
}

/// Runs every case of the oracles, and of the quick hard cases, contacts and forces that this machine can run, and tabulates the
/// times that they took.
fn measure_cases(times: &mut Vec<Table>) -> Vec<GateCase> {
    let oracles = oracles::families();
    let stability = stability::families(true);
    let contacts = contacts::families(true);
    let forces = forces::families(true);
    times.extend([
        families::times("oracles", &oracles),
        families::times("stability", &stability),
        families::times("contacts", &contacts),
        families::times("forces", &forces),
    ]);
    let forces = forces.into_iter().flat_map(|family| family.cases);
    let contacts = contacts.into_iter().flat_map(|family| family.cases);
    let oracles = oracles.into_iter().flat_map(|family| family.cases);
    let stability = stability.into_iter().flat_map(|family| family.cases);
    let built = stability.filter(|case| case.status == Status::Built);
    oracles
        .map(|case| GateCase { identity: format!("oracles: {}", case.name), fails: !case.pass })
        .chain(built.map(|case| GateCase {
            identity: format!("stability: {}, n = {}", case.name, case.n),
            fails: !case.pass,
        }))
        .chain(
            contacts.map(|row| GateCase {
                identity: format!("contacts: {}", row.name),
                fails: !row.pass,
            }),
        )
        .chain(
            forces.map(|row| GateCase {
                identity: format!("forces: {}", row.name),
                fails: !row.pass,
            }),
        )
        .collect()
}

fn outcome(
    differences: &Differences,
    cases: Option<&[GateCase]>,
    mut tables: Vec<Table>,
) -> Outcome {
    tables.push(Table {
        name: "gate".into(),
        title: format!("{} differences from the committed lists", differences.0.len()),
        headers: vec!["case", "difference"],
        rows: differences.0.iter().map(|row| row.to_vec()).collect(),
    });
    let json = json!({
        "differences": differences.0,
        "cases": cases.map(<[GateCase]>::len),
        "known_failures": KNOWN_FAILURES.lines().collect::<Vec<_>>(),
    });
    Outcome { json, tables, plots: Vec::new() }
}

fn write(cases: Option<&[GateCase]>, hashes: &[GoldenHash]) -> Result<()> {
    for hash in hashes {
        let deviations = hash.deviations.join("; ");
        ensure!(hash.deviations.is_empty(), "{} has no one hash: {deviations}", hash.scene);
    }
    write_list("golden_hashes.tsv", &golden::list(hashes))?;
    let Some(cases) = cases else { return Ok(()) };
    let mut failing: Vec<&str> =
        cases.iter().filter(|case| case.fails).map(|case| case.identity.as_str()).collect();
    failing.sort_unstable();
    let failing: String = failing.iter().map(|case| format!("{case}\n")).collect();
    write_list("known_failures.txt", &failing)
}

fn write_list(file: &str, list: &str) -> Result<()> {
    let path = Path::new(FOLDER).join(file);
    fs::write(&path, list).with_context(|| format!("cannot write {}", path.display()))
}
