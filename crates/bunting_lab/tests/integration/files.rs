//! Tests of meshes of files, with the troubles that files have.

use std::{f32::consts::TAU, fmt::Write, fs, process::Command};

/// A cape of seven by nine vertices: quads, and texture coordinates of an atlas.
fn cape() -> String {
    let mut obj = String::new();
    for (row, column) in (0..9).flat_map(|row| (0..7).map(move |column| (row, column))) {
        let (x, y) = (column as f32 * 0.12, 1.2 - row as f32 * 0.15);
        let bulge = 0.1 * (TAU * x).sin();
        writeln!(obj, "v {x} {y} {bulge}\nvt {} {}", 0.3 + 0.01 * x, 0.7).expect("a string");
    }
    for (row, column) in (0..8).flat_map(|row| (0..6).map(move |column| (row, column))) {
        let a = row * 7 + column + 1;
        let corners = [a, a + 7, a + 8, a + 1].map(|at| format!("{at}/{at}"));
        writeln!(obj, "f {}", corners.join(" ")).expect("a string");
    }
    obj
}

/// A tube in centimetres, whose seam has doubled vertices.
fn tube() -> String {
    let mut obj = String::new();
    for (row, column) in (0..12).flat_map(|row| (0..17).map(move |column| (row, column))) {
        let (sin, cos) = (TAU * (column % 16) as f32 / 16.0).sin_cos();
        writeln!(obj, "v {} {} {}", 20.0 * cos, 100.0 - 6.0 * row as f32, 20.0 * sin)
            .expect("a string");
    }
    for (row, column) in (0..11).flat_map(|row| (0..16).map(move |column| (row, column))) {
        let a = row * 17 + column + 1;
        writeln!(obj, "f {} {} {}\nf {} {} {}", a, a + 1, a + 18, a, a + 18, a + 17)
            .expect("a string");
    }
    obj
}

#[test]
fn meshes_of_files_are_cloths_or_say_why_not() {
    let folder = std::env::temp_dir().join(format!("bunting-lab-files-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    // A triangle without area, a vertex without triangle, a face twice: they can be repaired.
    let repaired = cape() + "v 0 0 0\nf 1 1 2\nf 1/1 8/8 9/9 2/2\n";
    let files = [
        ("cape.obj", cape()),
        ("tube.obj", tube()),
        ("repaired.obj", repaired),
        ("empty.obj", "v 0 0 0\n".to_owned()),
        ("broken.obj", "f nonsense\n".to_owned()),
        ("broken.glb", "no glTF".to_owned()),
        ("notes.txt", "no mesh".to_owned()),
    ];
    for (name, content) in files {
        fs::write(folder.join(name), content).expect("a file");
    }
    let path = folder.to_str().expect("a plain path");
    let output = Command::new(env!("CARGO_BIN_EXE_bunting_lab"))
        .args(["files", path, "--json"])
        .output()
        .expect("the binary runs");
    fs::remove_dir_all(&folder).expect("its own folder");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    let rows = json["files"].as_array().expect("rows");
    assert_eq!(rows.len(), 6);
    for row in rows {
        let file = row["file"].as_str().expect("a name");
        let figures = &row["figures"];
        if ["cape.obj", "tube.obj", "repaired.obj"].contains(&file) {
            let number =
                |key: &str| figures[key].as_f64().unwrap_or_else(|| panic!("{key}: {row}"));
            assert!(number("strain") < 0.1 && number("tension") < 3.0, "{row}");
            assert_eq!(number("compressed"), 0.0, "{row}");
            assert!(number("in_wind") < 10.0 && number("on_ball") < 50.0, "{row}");
        } else {
            let reason = row["refused"].as_str().unwrap_or_else(|| panic!("a reason: {row}"));
            assert!(reason.len() > 10 && figures.is_null(), "{row}");
        }
    }
}
