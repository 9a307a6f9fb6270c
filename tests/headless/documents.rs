//! The guide and the README state no times: these are in the document that the lab writes. The tests that the notebook names
//! exist.

use std::fs;
use std::path::Path;

/// Units of times that depend on a machine.
const UNITS: [&str; 6] = ["ms", "µs", "millisecond", "milliseconds", "microsecond", "microseconds"];

/// The words of a document that are units of such times, each with its line, without the lines of code.
fn times(text: &str) -> Vec<(usize, String)> {
    let mut in_code = false;
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        let mut words = line.split(|letter: char| !letter.is_alphabetic());
        if !in_code && words.any(|word| UNITS.contains(&word)) {
            found.push((index + 1, line.to_owned()));
        }
    }
    found
}

/// Texts of all files of Rust below a folder.
fn sources(folder: &Path) -> String {
    let mut texts = String::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            texts += &sources(&path);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            texts += &fs::read_to_string(&path).expect("a source");
        }
    }
    texts
}

/// Names of tests in a row of the table of public reports: of words in small letters.
fn tests_of(row: &str) -> impl Iterator<Item = &str> {
    let is_test = |name: &&str| {
        let is_of_name =
            |letter: char| letter.is_ascii_lowercase() || "_0123456789".contains(letter);
        name.contains('_') && name.chars().all(is_of_name)
    };
    row.split('`').skip(1).step_by(2).filter(is_test)
}

#[test]
fn tests_that_cover_public_reports_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = fs::read_to_string(root.join("docs/notebook/public-reports.md")).expect("the page");
    let sources = ["crates", "tests"].map(|folder| sources(&root.join(folder))).concat();
    let mut count = 0;
    for name in page.lines().filter(|line| line.starts_with('|')).flat_map(tests_of) {
        assert!(sources.contains(&format!("fn {name}(")), "there is no test {name}");
        count += 1;
    }
    assert!(count > 40, "{count} names");
}

#[test]
fn times_are_in_the_labs_document_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let guide = fs::read_dir(root.join("docs/guide")).expect("the guide");
    let pages = guide.map(|page| page.expect("a page").path());
    let mut documents: Vec<_> = pages.chain([root.join("README.md")]).collect();
    documents.sort();
    for path in documents {
        let text = fs::read_to_string(&path).expect("a document");
        let found = times(&text);
        assert!(found.is_empty(), "{}: {found:?}", path.display());
    }
    assert_eq!(times("A tick takes 0.3 ms.\n```\n2 ms\n```").len(), 1);
}
