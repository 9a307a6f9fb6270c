//! Tests that a valid scene loads, and that the error of any other names the line, the column and the key.

use std::path::Path;

use bunting_scenes::{Scene, SceneError, load, parse};

const GOOD: &str = r#"(
    winds: [(velocity: (5, 0, 0), gust_strength: 1)],
    viewer: (track: (waypoints: [(0, 2, 9), (9, 2, 9), (9, 2, 0)], speed: 1), looks_at: (0, 1, 0)),
    levels: (finest: 17, switch_distances: [10, 20]),
    materials: {
        "sail": (like: "nylon", area_density: 0.2),
    },
    vehicles: {
        "cart": (
            model: "cart.gltf",
            track: (waypoints: [(0, 0, 0), (9, 0, 0), (9, 0, 9)], speed: 4),
            socket: (0, 1, 0),
        ),
    },
    flags: [
        (on: Ground(x: 0, z: 0), pole: 6, size: (3, 2), material: "sail"),
        (on: Vehicle("cart"), pole: 2, size: (1, 0.5), material: "silk"),
    ],
)"#;

fn read(source: &str) -> Result<Scene, SceneError> {
    parse(source, Path::new("scene.ron"))
}

/// Replaces `part` of the valid scene by `bad`, and expects an error at the line and column of `at` in `bad`,
/// with the given key and reason.
#[track_caller]
fn expect_error(part: &str, bad: &str, at: &str, expected_key: &str, expected_reason: &str) {
    let source = GOOD.replacen(part, bad, 1);
    assert_ne!(source, GOOD, "{part} is not in the scene");
    let error = read(&source).expect_err("the scene is bad");
    let SceneError::BadValue { line, column, key, reason, .. } = &error else { panic!("{error}") };
    let offset =
        source.find(bad).expect("it was put there") + bad.find(at).expect("it is in there");
    let before = &source[..offset];
    let expected_line = 1 + before.matches('\n').count();
    let expected_column = 1 + before.chars().rev().take_while(|&letter| letter != '\n').count();
    assert_eq!(
        (key.as_str(), *line, *column),
        (expected_key, expected_line, expected_column),
        "{error}"
    );
    assert!(reason.contains(expected_reason), "{error}");
}

#[test]
fn a_good_scene_loads() {
    let scene = read(GOOD).expect("the scene is good");
    assert_eq!(scene.flags.len(), 2);
    assert_eq!(scene.material("sail").expect("it is the scene's own").area_density, 0.2);
}

#[test]
fn the_shipped_scene_loads() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/flags.ron");
    let scene = load(file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.flags.len(), 8);
    assert_eq!(scene.vehicles.len(), 2);
}

#[test]
fn a_missing_file_is_named() {
    let error = load("no/such/scene.ron").expect_err("there is none");
    assert!(error.to_string().starts_with("no/such/scene.ron: "), "{error}");
}

#[test]
fn errors_name_the_file() {
    let error = read(&GOOD.replace("flags:", "flag:")).expect_err("the scene is bad");
    assert!(error.to_string().starts_with("scene.ron:15:5: flag: "), "{error}");
}

#[test]
fn an_unknown_key() {
    expect_error(
        "gust_strength: 1",
        "strength: 1",
        "strength",
        "winds[0].strength",
        "gust_strength",
    );
}

#[test]
fn a_missing_key() {
    expect_error(
        "(on: Ground(x: 0, z: 0), pole: 6",
        "(on: Ground(x: 0, z: 0)",
        "(on",
        "flags[0]",
        "pole",
    );
}

#[test]
fn a_wrong_type() {
    expect_error("pole: 6", "pole: \"six\"", "\"six\"", "flags[0].pole", "float");
}

#[test]
fn unbalanced_brackets() {
    let error = read(&GOOD[..GOOD.len() - 2]).expect_err("the scene is bad");
    assert!(error.to_string().starts_with("scene.ron:18:7: scene: "), "{error}");
}

#[test]
fn an_unknown_material() {
    expect_error("\"silk\"", "\"velvet\"", "\"velvet\"", "flags[1].material", "velvet");
}

#[test]
fn an_unknown_preset() {
    expect_error(
        "like: \"nylon\"",
        "like: \"nylons\"",
        "\"nylons\"",
        "materials.sail.like",
        "nylons",
    );
}

#[test]
fn an_invalid_material() {
    expect_error("density: 0.2", "density: -0.2", "-0.2", "materials.sail.area_density", "-0.2");
}

#[test]
fn no_flags() {
    let start = GOOD.find("flags: [").expect("there are flags") + "flags: [".len();
    let source = format!("{}],)", &GOOD[..start]);
    let error = read(&source).expect_err("the scene is bad");
    assert!(error.to_string().starts_with("scene.ron:15:12: flags: "), "{error}");
}

#[test]
fn a_negative_size() {
    expect_error("size: (1, 0.5)", "size: (1, -0.5)", "-0.5", "flags[1].size[1]", "not positive");
}

#[test]
fn an_unknown_vehicle() {
    expect_error("Vehicle(\"cart\")", "Vehicle(\"card\")", "Vehicle", "flags[1].on", "card");
}

#[test]
fn a_speed_beyond_bounds() {
    expect_error("speed: 4", "speed: 40", "40", "vehicles.cart.track.speed", "20");
}

#[test]
fn too_few_waypoints() {
    expect_error(
        "[(0, 0, 0), (9, 0, 0), (9, 0, 9)]",
        "[(0, 0, 0), (9, 0, 0)]",
        "[",
        "vehicles.cart.track.waypoints",
        "3",
    );
}

#[test]
fn levels_that_do_not_halve() {
    expect_error("finest: 17", "finest: 16", "16", "levels.finest", "16");
    expect_error("[10, 20]", "[10, 5]", "5", "levels.switch_distances[1]", "10");
}
