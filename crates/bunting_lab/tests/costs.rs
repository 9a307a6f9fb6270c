//! The JSON of what measures costs and levels.

use bunting_lab::{
    budget::phases::PHASES,
    commands::{budget, lod, schedule},
};
use serde_json::Value;

#[track_caller]
fn assert_positive(row: &Value, keys: &[&str]) {
    for key in keys {
        assert!(row[key].as_f64().is_some_and(|value| value > 0.0), "{key} in {row}");
    }
}

fn rows<'a>(json: &'a Value, key: &str) -> &'a Vec<Value> {
    let rows = json[key].as_array().expect(key);
    assert!(!rows.is_empty(), "{key}");
    rows
}

#[test]
fn budget_has_its_schema() {
    let json = budget::run(true).json;
    assert!(json["instruction_set"].is_string());
    for sheet in rows(&json, "sheets") {
        assert_positive(sheet, &["n", "cloths", "cores", "ms_per_tick", "over_one_core"]);
        assert!(sheet["cores"] != 1 || sheet["over_one_core"] == 1.0, "{sheet}");
    }
    let phases = rows(&json, "phases");
    for phase in phases {
        assert_positive(phase, &["n", "share"]);
        assert!(PHASES.contains(&phase["phase"].as_str().expect("a name")));
    }
    for level in phases.chunks(PHASES.len()) {
        let whole: f64 = level.iter().filter_map(|phase| phase["share"].as_f64()).sum();
        assert!((whole - 1.0).abs() < 1e-9, "{whole}");
    }
    for key in ["ns_per_constraint", "ns_per_wind_triangle"] {
        assert!(json["kernels"][key].is_number(), "{key}");
    }
    let thousand = &json["thousand"];
    assert_positive(thousand, &["ms_median", "ms_p95", "ms_worst_second"]);
    let ticking: f64 = rows(thousand, "per_level").iter().filter_map(Value::as_f64).sum();
    let flags = ticking + thousand["asleep"].as_f64().expect("a number");
    assert!((flags - 1000.0).abs() < 1e-6, "{flags}");
}

#[test]
fn schedule_compares_app_and_plain_calls() {
    let json = schedule::run(true).json;
    assert!(json["instruction_set"].is_string());
    for row in rows(&json, "rows") {
        assert_positive(row, &["n", "cloths", "us_app", "us_cloth_tick", "us_plain", "ratio"]);
    }
}

#[test]
fn lod_compares_levels_and_changes_them() {
    let json = lod::run(true).json;
    assert!(json["instruction_set"].is_string());
    for level in rows(&json, "levels") {
        assert_positive(level, &["n", "droop_m", "swing_period_s", "tip_spread_m", "flutter_hz"]);
    }
    for switch in rows(&json, "switches") {
        assert_positive(switch, &["from", "to", "pop_rms_m", "pop_max_m"]);
        for key in ["momentum_jump", "kinetic_jump", "energy_jump"] {
            assert!(switch[key].is_number(), "{key} in {switch}");
        }
    }
}

#[test]
fn no_change_of_level_is_seen() {
    for pop in rows(&lod::run(true).json, "pops") {
        assert_positive(pop, &["from", "to", "distance_m", "mean_px", "own_px", "twin_px"]);
        assert!(pop["worst_px"].as_f64().is_some_and(|pixels| pixels < 1.0), "{pop}");
    }
}

#[cfg(feature = "peers")]
#[test]
fn every_engine_hangs_a_cloth() {
    use bunting_lab::{
        peers::{engine::Engine, measurement::hang},
        scenes::Scene,
    };
    let scene = Scene { seconds: 3.0, ..Scene::hang_top(5) };
    for engine in Engine::all() {
        let row = hang(&engine, &scene);
        assert!(row.max_stretch.is_some_and(|strain| strain < 0.01), "{row:?}");
    }
}
