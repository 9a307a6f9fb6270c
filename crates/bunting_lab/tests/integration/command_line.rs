//! Tests of the binary's exit codes, JSON and files.

use std::process::{Command, Output};

fn lab(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bunting_lab"))
        .args(arguments)
        .output()
        .expect("the binary runs")
}

#[test]
fn bad_arguments_exit_with_two() {
    for arguments in [
        &["nonsense"][..],
        &[],
        &["pareto", "--sizes", "1"],
        &["pareto", "--scenes", "moon"],
        &["pareto", "--time-limit", "0"],
    ] {
        let output = lab(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn pareto_prints_one_json_object_and_writes_files() {
    let folder = std::env::temp_dir().join(format!("bunting-lab-pareto-{}", std::process::id()));
    let out = folder.to_str().expect("a plain path");
    let figure = folder.join("figure.svg");
    let figure_path = figure.to_str().expect("a plain path");
    let output = lab(&[
        "pareto",
        "--quick",
        "--scenes",
        "swing",
        "--json",
        "--out",
        out,
        "--figure",
        figure_path,
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    let rows = json["rows"].as_array().expect("rows");
    assert!(rows.len() >= 10);
    assert!(json["instruction_set"].is_string());
    for part in json["ablation"].as_array().expect("ablation") {
        assert!(part["part"].is_string(), "{part}");
        for key in ["us_per_cloth_tick", "us_ratio", "strain_error", "flag_strain_p999"] {
            assert!(part[key].is_number(), "{key} in {part}");
        }
    }
    let error_without = |name: &str| {
        let parts = json["ablation"].as_array().expect("ablation");
        let part = parts.iter().find(|part| part["part"] == name).expect("a part");
        part["rms_error_m"].as_f64().expect("an error")
    };
    assert!(error_without("no air") > 10.0 * error_without("whole model"));
    assert!(json["left_out"].is_array());
    for row in rows {
        for key in ["scene", "n", "method", "substeps", "passes", "lanes", "stable"] {
            assert!(!row[key].is_null(), "{key} in {row}");
        }
        let stable = row["stable"].as_bool() == Some(true);
        for key in
            ["us_per_cloth_tick", "rms_error_m", "mean_stretch", "max_stretch", "strain_error"]
        {
            assert!(!stable || row[key].is_number(), "{key} in {row}");
        }
    }
    let table = std::fs::read_to_string(folder.join("pareto_swing_9.csv")).expect("a table");
    assert_eq!(table.lines().count(), rows.len() + 1);
    assert!(folder.join("pareto_swing_9.svg").exists());
    let figure = std::fs::read_to_string(figure).expect("a figure");
    for name in ["Pareto front", "this project, alone", "XPBD", "PBD"] {
        assert!(figure.contains(name), "{name}");
    }
    std::fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
fn a_method_that_takes_too_long_is_left_out_and_named() {
    let output =
        lab(&["pareto", "--quick", "--scenes", "swing", "--json", "--time-limit", "0.000001"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(json["rows"].as_array().map(Vec::len), Some(0));
    let left_out = json["left_out"].as_array().expect("all of them");
    assert!(left_out.len() >= 10, "{left_out:?}");
    for left_out in left_out {
        assert!(left_out["method"].is_string() && left_out["n"] == 9, "{left_out}");
    }
}

/// The cases of some families that a command prints as JSON, plots and tabulates. The gate runs all of them.
fn cases(command: &str, families: &[&str]) -> Vec<serde_json::Value> {
    let folder = std::env::temp_dir().join(format!("bunting-lab-{command}-{}", std::process::id()));
    let out = folder.to_str().expect("a plain path");
    let mut arguments = vec![command, "--quick", "--json", "--out", out];
    arguments.extend(families.iter().flat_map(|name| ["--family", name]));
    let output = lab(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let plot = std::fs::read_to_string(folder.join(format!("{command}.svg"))).expect("a plot");
    assert!(plot.contains("passes") && plot.contains("<circle"), "{command}");
    let table = std::fs::read_to_string(folder.join(format!("{command}.csv"))).expect("a table");
    std::fs::remove_dir_all(folder).expect("the folder is ours");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    let names: Vec<&str> = json["families"]
        .as_array()
        .expect("families")
        .iter()
        .map(|it| it["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, families);
    let cases = json["cases"].as_array().expect("cases").clone();
    assert_eq!(table.lines().count(), cases.len() + 1, "{command}");
    cases
}

#[test]
fn oracles_print_their_cases() {
    let cases = cases("oracles", &["free fall", "static stretch", "drag"]);
    assert!(cases.len() >= 15, "{}", cases.len());
    for case in cases {
        assert!(case["name"].is_string() && case["pass"].is_boolean(), "{case}");
        for key in ["expected", "measured", "relative_error", "tolerance"] {
            assert!(case[key].is_number(), "{key} in {case}");
        }
        let met = case["relative_error"].as_f64() <= case["tolerance"].as_f64();
        assert_eq!(case["pass"].as_bool(), Some(met), "{case}");
    }
}

#[test]
fn stability_prints_its_cases() {
    let cases = cases("stability", &["levels, lanes and input", "sleep"]);
    assert!(cases.len() >= 10, "{}", cases.len());
    for case in cases {
        assert!(case["name"].is_string() && case["n"].is_u64(), "{case}");
        assert!(case["limit"].is_number() && case["pass"].is_boolean(), "{case}");
        assert!(case["worst"].is_number() || case["worst"].is_null(), "{case}");
        let built = case["status"] == "built";
        // A value that is not a number has no worst figure and does not pass.
        let holds =
            case["worst"].as_f64().is_some_and(|worst| Some(worst) <= case["limit"].as_f64());
        assert_eq!(case["pass"], built && holds, "{case}");
        assert!(built || case["status"] == "not_built", "{case}");
    }
}

#[test]
fn a_family_that_does_not_exist_is_refused() {
    let output = lab(&["stability", "--family", "juggling"]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("juggling") && error.contains("soundness"), "{error}");
}
