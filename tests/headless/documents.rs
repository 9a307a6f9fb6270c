//! The guide and the README state no times: these are in the document that the lab writes.

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
