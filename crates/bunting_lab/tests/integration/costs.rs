//! Tests of the JSON of commands that measure costs and levels.

use bunting_lab::{
    budget::{
        parts::{EXTRAS, PARTS},
        phases::PHASES,
    },
    commands::{budget, lod, schedule},
    settings::{LEVELS, schemes},
};
use bunting_solver::LaneCount;
use serde_json::Value;

/// Factor by which two times of the same work may differ where other programs use the machine.
const BUSY: f64 = 5.0;
/// Relative difference of the droop and of the swing's period between levels.
const LEVELS_AGREE: f64 = 0.05;
/// Change of the momentum in a change of level, over the momentum: rounding is 2e-7.
const MOMENTUM: f64 = 1e-5;
/// Energy that a change of level may add, over the kinetic energy: rounding. It may remove any amount.
const ENERGY: f64 = 0.01;
/// Mean kinetic energy that a change of level may remove, over the kinetic energy. Measured: up to 0.12.
const KINETIC_LOSS: f64 = 0.2;

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
    for sheet in rows(&json, "many_flags") {
        assert_positive(sheet, &["n", "cloths", "cores", "ms_per_tick", "over_one_core"]);
        assert!(sheet["cores"] != 1 || sheet["over_one_core"] == 1.0, "{sheet}");
    }
    let phases = rows(&json, "phases");
    for phase in phases {
        assert_positive(phase, &["n", "us", "fraction"]);
        assert!(PHASES.contains(&phase["phase"].as_str().expect("a name")));
    }
    // The phases of the finest level add up to a tick of a full batch, which was timed separately.
    let us = |phase: &Value| phase["us"].as_f64().expect("a time");
    let phases_us: f64 = phases[..PHASES.len()].iter().map(us).sum();
    let lanes = LaneCount::holding(usize::MAX).get();
    let sheet = rows(&json, "many_flags").iter().find(|it| it["n"] == 33 && it["cloths"] == lanes);
    let sheet_us = 1e3 * sheet.expect("a full batch")["ms_per_tick"].as_f64().expect("a time");
    let ratio = phases_us / sheet_us;
    assert!((1.0 / BUSY..BUSY).contains(&ratio), "{phases_us} µs and {sheet_us} µs");
    let parts = rows(&json, "parts");
    assert_eq!(parts.len(), LEVELS.len() * (PARTS.len() + EXTRAS.len()));
    for level in parts.chunks(PARTS.len() + EXTRAS.len()) {
        // Errors of differences cancel in the sum: one part takes too much, another too little.
        let whole: f64 = level[..PARTS.len()].iter().filter_map(|it| it["fraction"].as_f64()).sum();
        assert!((whole - 1.0).abs() < 1e-9, "{whole}");
        for name in ["prediction, damping", "velocities", "normals"] {
            let part = level.iter().find(|part| part["part"] == name).expect(name);
            assert_positive(part, &["us"]);
        }
    }
    let distances = rows(&json, "distances");
    let level = |row: &Value| {
        let flags = row["per_level"].as_array().expect("levels");
        flags.iter().position(|flags| flags == 8).expect("all flags at one level")
    };
    let levels: Vec<usize> = distances.iter().map(level).collect();
    assert!(levels.is_sorted() && levels[0] == 0, "{levels:?}");
    assert_eq!(levels.last(), Some(&(LEVELS.len() - 1)));
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
    let rows = rows(&json, "rows");
    assert_eq!(rows.len(), schemes().len() * LEVELS.len());
    for row in rows {
        assert_positive(row, &["n", "cloths", "us_app", "us_cloth_tick", "us_plain", "ratio"]);
        // The cloth tick is a part of the app's update.
        assert!(row["us_cloth_tick"].as_f64() < row["us_app"].as_f64(), "{row}");
    }
}

#[test]
fn lod_compares_levels_and_changes_them() {
    let json = lod::run(true).json;
    assert!(json["instruction_set"].is_string());
    let levels = rows(&json, "levels");
    for level in levels {
        assert_positive(level, &["n", "droop_m", "swing_period_s", "tip_spread_m", "flutter_hz"]);
        let finest = levels.iter().find(|other| other["scheme"] == level["scheme"]);
        for key in ["droop_m", "swing_period_s"] {
            let [here, there] = [level, finest.expect("itself")].map(|it| it[key].as_f64());
            let ratio = here.expect(key) / there.expect(key);
            assert!((ratio - 1.0).abs() < LEVELS_AGREE, "{key} in {level}");
        }
    }
    let switches = rows(&json, "switches");
    assert_eq!(switches.len(), 8, "two schemes, two pairs of levels, both ways");
    for switch in switches {
        assert_positive(switch, &["from", "to", "pop_rms_m", "pop_max_m"]);
        let figure = |key: &str| switch[key].as_f64().unwrap_or(f64::NAN);
        assert!(figure("momentum_jump") <= MOMENTUM, "{switch}");
        assert!(figure("momentum_worst") <= MOMENTUM, "{switch}");
        assert!(figure("energy_worst") <= ENERGY, "{switch}");
        assert!((-KINETIC_LOSS..=ENERGY).contains(&figure("kinetic_jump")), "{switch}");
        assert!(figure("energy_jump") <= figure("energy_worst"), "{switch}");
    }
}

#[test]
fn no_change_of_level_is_seen() {
    let json = lod::run(true).json;
    let pops = rows(&json, "pops");
    assert_eq!(pops.len(), 8, "two schemes, two pairs of levels, both ways");
    for pop in pops {
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
