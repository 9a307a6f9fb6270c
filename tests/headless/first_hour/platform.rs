//! Item 12: std's clock panics on wasm32; Bevy's does not.

use std::fs;
use std::path::Path;

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
fn only_bevys_clock_is_used() {
    let mut files = 0;
    for name in ["bevy_bunting", "bunting_solver"] {
        let sources =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates").join(name).join("src");
        for_each_source(&sources, &mut |path, text| {
            files += 1;
            // The path of the sources itself leads through a folder `tests`.
            let within = path.strip_prefix(&sources).expect("a file among the sources");
            let is_test = within.components().any(|part| part.as_os_str() == "tests");
            let asks = |line: &&str| {
                let is_std = line.contains("std::") && line.contains("time::");
                line.contains("Instant") && is_std && !line.starts_with("//")
                    || line.contains("SystemTime")
            };
            let line = text.lines().find(asks).filter(|_| !is_test);
            assert_eq!(line, None, "{} asks std for the time", path.display());
        });
    }
    assert!(files > 50);
}
