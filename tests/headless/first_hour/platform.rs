//! Item 12: std's clock panics on wasm32; Bevy's does not. Browsers have no threads, files and processes, either.

use std::fs;
use std::path::Path;

/// Modules of std that browsers lack.
const LACKING: [&str; 6] =
    ["std::env", "std::fs", "std::net", "std::process", "std::thread::", "std::thread;"];

/// Calls a function with the path and text of each Rust file under a folder.
fn for_each_source(folder: &Path, check: &mut impl FnMut(&Path, &str)) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            for_each_source(&path, check);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            check(&path, &fs::read_to_string(&path).expect("a text"));
        }
    }
}

#[test]
fn browsers_have_what_is_used() {
    let mut files = 0;
    for name in ["bevy_bunting", "bevy_bunting_avian", "bunting_solver"] {
        let sources =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates").join(name).join("src");
        for_each_source(&sources, &mut |path, text| {
            files += 1;
            // The path of the sources itself leads through a folder `tests`.
            let within = path.strip_prefix(&sources).expect("a file among the sources");
            let is_test = within.components().any(|part| part.as_os_str() == "tests");
            let asks = |line: &&str| {
                let is_std = line.contains("std::") && line.contains("time::");
                let is_clock = line.contains("Instant") && is_std || line.contains("SystemTime");
                let is_code = !line.trim_start().starts_with("//");
                is_code && (is_clock || LACKING.iter().any(|module| line.contains(module)))
            };
            let line = text.lines().find(asks).filter(|_| !is_test);
            assert_eq!(line, None, "{} asks std for what browsers lack", path.display());
        });
    }
    assert!(files > 50);
}
