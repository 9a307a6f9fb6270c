//! Files of a crate do not import one another in circles: A imports B if A names what B defines, wherever it is re-exported.
//!
//! Re-exports are doors, not imports, and code of tests does not count. A method does not tell in which file it is: calls of
//! methods do not count either.

mod crate_tree;
mod tokens;

use crate_tree::CrateTree;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What a file takes from others: names by file.
type Imports = BTreeMap<usize, BTreeSet<String>>;

#[test]
fn no_files_import_one_another_in_a_circle() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let mut told = String::new();
    let mut arrows = 0;
    for root in roots(workspace) {
        let tree = CrateTree::read(&root);
        let imports = tree.imports();
        arrows += imports.iter().map(BTreeMap::len).sum::<usize>();
        for circle in circles(&imports) {
            told += &format!("\na circle of {} files:\n", circle.len());
            for (&file, &other) in circle.iter().flat_map(|a| circle.iter().map(move |b| (a, b))) {
                if let Some(names) = imports[file].get(&other) {
                    let names = Vec::from_iter(names.iter().map(String::as_str)).join(", ");
                    let [file, other] = [file, other].map(|file| {
                        tree.files[file].strip_prefix(workspace).unwrap().display().to_string()
                    });
                    told += &format!("  {file} takes from {other}: {names}\n");
                }
            }
        }
    }
    assert!(arrows > 1000, "only {arrows} imports are found: the source is not read");
    assert!(
        told.is_empty(),
        "{told}\nMove what closes a circle to a file of its own, or to its user."
    );
}

/// The first file of every crate that is no test.
fn roots(workspace: &Path) -> Vec<PathBuf> {
    let packages = std::fs::read_dir(workspace.join("crates")).unwrap();
    let packages = packages.map(|package| package.unwrap().path());
    let mut roots: Vec<_> = packages
        .chain([workspace.join("examples")])
        .flat_map(|package| {
            ["src/lib.rs", "src/main.rs", "gallery/main.rs"].map(|file| package.join(file))
        })
        .filter(|root| root.exists())
        .collect();
    roots.sort();
    roots
}

/// The greatest sets of files each of which reaches all others.
fn circles(imports: &[Imports]) -> Vec<Vec<usize>> {
    let reached: Vec<BTreeSet<usize>> = (0..imports.len())
        .map(|file| {
            let mut reached = BTreeSet::new();
            let mut next = vec![file];
            while let Some(file) = next.pop() {
                next.extend(imports[file].keys().filter(|&&other| reached.insert(other)));
            }
            reached
        })
        .collect();
    let mut circles = BTreeSet::new();
    for file in (0..imports.len()).filter(|&file| reached[file].contains(&file)) {
        circles.insert(Vec::from_iter(
            reached[file].iter().copied().filter(|&other| reached[other].contains(&file)),
        ));
    }
    circles.into_iter().collect()
}
