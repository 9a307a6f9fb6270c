//! Differences between the gate's measurements and the committed lists.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    figures,
    gate_cases::{GateCase, Verdict},
};
use crate::{
    figure::Figure,
    golden::{self, GoldenHash},
};

/// Factor by which the figure of a known failure may exceed that of the list. Less: motion that an error drives is chaotic,
/// and differs by a few per cent from edition to edition.
const WORSE: f64 = 1.2;

/// Identities of the list of known failures with their figures; none for those that are not compared.
pub fn known_failures(list: &str) -> BTreeMap<&str, Option<f64>> {
    let entry = |line| match str::split_once(line, '\t') {
        Some((identity, figure)) => (identity, figure.parse().ok()),
        None => (line, None),
    };
    list.lines().map(entry).collect()
}

/// Differences from the committed lists: the case or hash, and how it differs.
#[derive(Debug, Default)]
pub struct Differences(pub Vec<[String; 2]>);

impl Differences {
    fn add(&mut self, what: impl Into<String>, how: impl Into<String>) {
        self.0.push([what.into(), how.into()]);
    }

    /// Compares cases with the list of known failures, an identity and a figure a line.
    pub fn compare_cases(&mut self, list: &str, cases: &[GateCase]) {
        let mut counts = BTreeMap::new();
        for case in cases {
            *counts.entry(case.identity.as_str()).or_insert(0) += 1;
        }
        for (identity, count) in counts.iter().filter(|(_, count)| **count > 1) {
            self.add(*identity, format!("is the identity of {count} cases"));
        }
        let figures = known_failures(list);
        let known: BTreeSet<&str> = figures.keys().copied().collect();
        let of = |verdict: Verdict| {
            cases.iter().filter(move |case| case.verdict == verdict).map(|it| it.identity.as_str())
        };
        let failing: BTreeSet<&str> = of(Verdict::Fails).collect();
        let unclear: BTreeSet<&str> = of(Verdict::Unclear).collect();
        for case in known.difference(&failing).filter(|case| !unclear.contains(**case)) {
            let how = if counts.contains_key(case) { "passes" } else { "does not exist" };
            self.add(*case, format!("is on the list of known failures, and {how}"));
        }
        let failing = cases.iter().filter(|case| case.verdict == Verdict::Fails);
        for GateCase { identity, error, limit, .. } in failing {
            let how = match (figures.get(identity.as_str()), *error) {
                (None, error) => {
                    let error =
                        error.map_or(String::new(), |it| format!(": {it:.3e}, limit {limit:.3e}"));
                    format!("fails, and is not on the list of known failures{error}")
                }
                // What is no number any more is worse than any.
                (Some(Some(known)), Some(error)) if error.is_nan() || error > WORSE * known => {
                    format!("has {error:.3e}, worse than the {known:.3e} of the list")
                }
                _ => continue,
            };
            self.add(identity, how);
        }
    }

    /// Compares figures with those of the committed file.
    pub fn compare_figures(&mut self, expected: &str, measured: &[Figure]) {
        self.0.extend(figures::differences(expected, measured));
    }

    /// Compares hashes with the expected ones.
    pub fn compare_hashes(&mut self, expected: &str, hashes: &[GoldenHash]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn cases(verdicts: &[(&str, bool)]) -> Vec<GateCase> {
        let case = |&(identity, fails): &(&str, bool)| GateCase {
            identity: identity.into(),
            verdict: if fails { Verdict::Fails } else { Verdict::Passes },
            error: None,
            limit: 1.0,
            figure: None,
        };
        verdicts.iter().map(case).collect()
    }

    fn differences(known_failures: &str, verdicts: &[(&str, bool)]) -> Vec<[String; 2]> {
        let mut differences = Differences::default();
        differences.compare_cases(known_failures, &cases(verdicts));
        differences.0
    }

    #[test]
    fn cases_that_newly_fail_pass_or_vanish_are_differences() {
        let verdicts = [("a", true), ("b", true), ("c", false)];
        assert!(differences("a\nb\n", &verdicts).is_empty());
        for (known, case, how) in [
            ("a\n", "b", "not on the list"),
            ("a\nb\nc\n", "c", "and passes"),
            ("a\nb\nd\n", "d", "and does not exist"),
        ] {
            let [[what, found]] = &differences(known, &verdicts)[..] else { panic!("{known:?}") };
            assert!(what == case && found.contains(how), "{what} {found}");
        }
    }

    #[test]
    fn unclear_cases_may_be_known_to_fail_or_not() {
        let unclear = GateCase {
            identity: "a".into(),
            verdict: Verdict::Unclear,
            error: None,
            limit: 1.0,
            figure: None,
        };
        for known in ["", "a\n"] {
            let mut differences = Differences::default();
            differences.compare_cases(known, std::slice::from_ref(&unclear));
            assert!(differences.0.is_empty(), "{differences:?}");
        }
    }

    #[test]
    fn a_known_failure_that_becomes_worse_is_a_difference() {
        let failing = |error| {
            [GateCase {
                identity: "a".into(),
                verdict: Verdict::Fails,
                error,
                limit: 1.0,
                figure: None,
            }]
        };
        let count = |list: &str, error| {
            let mut differences = Differences::default();
            differences.compare_cases(list, &failing(error));
            differences.0.len()
        };
        assert_eq!(count("a\t2.0\n", Some(2.3)), 0);
        assert_eq!(count("a\t2.0\n", Some(2.5)), 1);
        assert_eq!(count("a\t2.0\n", Some(f64::NAN)), 1);
        // What is not compared.
        assert_eq!(count("a\t–\n", Some(9.0)), 0);
        assert_eq!(count("a\n", Some(9.0)), 0);
    }

    #[test]
    fn a_line_of_the_list_is_read_as_it_is_written() {
        let case = GateCase {
            identity: "a, n = 1".into(),
            verdict: Verdict::Fails,
            error: Some(0.0123456),
            limit: 0.01,
            figure: None,
        };
        assert_eq!(known_failures(&case.line())["a, n = 1"], Some(1.235e-2));
        let unknown = GateCase { error: None, ..case };
        assert_eq!(known_failures(&unknown.line())["a, n = 1"], None);
    }

    #[test]
    fn two_cases_of_one_identity_are_a_difference() {
        for fails in [[false, false], [true, true], [true, false]] {
            let found = differences("a\n", &[("a", true), ("b", false), ("a", fails[0])]);
            assert!(found[0][1].contains("2 cases"), "{found:?}");
            let found = differences("", &[("b", false), ("b", false)]);
            assert_eq!(found.len(), 1, "{found:?}");
        }
    }

    #[test]
    fn other_hashes_missing_scenes_and_deviations_are_differences() {
        let hash = |deviations| {
            [GoldenHash { scene: "a", hashes: [1, 2], deviations, figures: Vec::new() }]
        };
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
