//! What must hold of every landing: golden hashes, closed forms, hard cases, against committed lists.

use std::{collections::BTreeSet, fs, path::PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde_json::json;

use super::{oracles, stability};
use crate::{
    golden::{self, GoldenHash},
    output::{Outcome, table::Table},
};

/// How the gate is run.
#[derive(Clone, Copy, Debug, Args)]
pub struct Options {
    /// Write the lists as they are measured, instead of comparing with them.
    #[arg(long)]
    write: bool,
    /// Only the golden hashes: seconds instead of minutes.
    #[arg(long)]
    hashes: bool,
}

/// The committed list of cases that are known to fail, a line a case.
const KNOWN_FAILURES: &str = include_str!("../../expected/known_failures.txt");

/// What differs from the committed lists.
#[derive(Debug, Default)]
struct Differences(Vec<[String; 2]>);

impl Differences {
    fn add(&mut self, what: impl Into<String>, how: impl Into<String>) {
        self.0.push([what.into(), how.into()]);
    }

    /// Compares failing cases with those that are known to fail.
    fn compare_failures(&mut self, known: &str, failing: &BTreeSet<String>) {
        let known: BTreeSet<&str> = known.lines().collect();
        for case in failing.iter().filter(|case| !known.contains(case.as_str())) {
            self.add(case, "fails, and did not");
        }
        for case in known.iter().filter(|case| !failing.contains(**case)) {
            self.add(*case, "is on the list of known failures, and passes or is gone");
        }
    }

    /// Compares hashes with those that are expected.
    fn compare_hashes(&mut self, expected: &str, hashes: &[GoldenHash]) {
        let measured = golden::list(hashes);
        for line in measured.lines().filter(|line| !expected.lines().any(|it| it == *line)) {
            self.add(line, "hash is not as expected");
        }
        for line in expected.lines().filter(|line| !measured.lines().any(|it| it == *line)) {
            self.add(line, "hash was expected");
        }
        for hash in hashes {
            for deviation in &hash.deviations {
                self.add(hash.scene, format!("differs at {deviation}"));
            }
        }
    }
}

/// Runs everything and compares it with the committed lists.
///
/// # Errors
///
/// When anything differs from the lists, after the differences have been printed; or when lists are to
/// be written and cannot be.
pub fn run(options: Options, present: impl FnOnce(&Outcome) -> Result<()>) -> Result<()> {
    let failing: BTreeSet<String> = if options.hashes {
        KNOWN_FAILURES.lines().map(str::to_owned).collect()
    } else {
        oracles::failing().into_iter().chain(stability::failing(true)).collect()
    };
    let hashes = golden::measure();
    if options.write {
        return write(&failing, &hashes);
    }
    let mut differences = Differences::default();
    differences.compare_failures(KNOWN_FAILURES, &failing);
    differences.compare_hashes(golden::EXPECTED, &hashes);
    present(&outcome(&differences, &failing))?;
    let count = differences.0.len();
    ensure!(count == 0, "{count} differences from the committed lists");
    eprintln!("the gate holds: {} cases are known to fail", failing.len());
    Ok(())
}

fn outcome(differences: &Differences, failing: &BTreeSet<String>) -> Outcome {
    let table = Table {
        name: "gate".into(),
        title: format!("{} differences from the committed lists", differences.0.len()),
        headers: vec!["case", "difference"],
        rows: differences.0.iter().map(|row| row.to_vec()).collect(),
    };
    let json = json!({ "differences": differences.0, "known_failures": failing });
    Outcome { json, tables: vec![table], plots: Vec::new() }
}

fn write(failing: &BTreeSet<String>, hashes: &[GoldenHash]) -> Result<()> {
    for hash in hashes {
        let deviations = hash.deviations.join("; ");
        ensure!(hash.deviations.is_empty(), "{} has no one hash: {deviations}", hash.scene);
    }
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("expected");
    let failures: String = failing.iter().map(|case| format!("{case}\n")).collect();
    for (file, text) in
        [("known_failures.txt", failures), ("golden_hashes.tsv", golden::list(hashes))]
    {
        let path = folder.join(file);
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_newly_fails_and_what_newly_passes_are_differences() {
        let failing = BTreeSet::from(["a".to_owned(), "b".to_owned()]);
        let count = |known: &str| {
            let mut differences = Differences::default();
            differences.compare_failures(known, &failing);
            differences.0.len()
        };
        assert_eq!(["a\nb\n", "a\n", "a\nb\nc\n", "c\n"].map(count), [0, 1, 1, 3]);
    }

    #[test]
    fn other_hashes_missing_scenes_and_deviations_are_differences() {
        let hash = |deviations| [GoldenHash { scene: "a", hashes: [1, 2], deviations }];
        let count = |expected: &str, deviations: Vec<String>| {
            let mut differences = Differences::default();
            differences.compare_hashes(expected, &hash(deviations));
            differences.0.len()
        };
        let same = "a\t0000000000000001\t0000000000000002\n";
        assert_eq!(count(same, Vec::new()), 0);
        assert_eq!(count(same, vec!["8 lanes".into()]), 1);
        assert_eq!(count("a\t0000000000000001\t0000000000000003\n", Vec::new()), 2);
        assert_eq!(count("", Vec::new()), 1);
    }
}
