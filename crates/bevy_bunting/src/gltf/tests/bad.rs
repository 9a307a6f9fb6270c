//! Files with mistakes: messages name the file, the node and the key, and all else is imported.

use super::*;

/// Imports a changed copy of the flag's file, and returns the messages.
fn import(case: &str, from: &str, to: &str) -> (App, Vec<String>) {
    let folder = std::env::temp_dir().join(format!("bunting-{}-{case}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = std::fs::read_to_string(assets().join("cloths/flag.gltf")).expect("the file");
    // Without the line breaks, so that cases can be written as JSON.
    let text: String = text.lines().map(str::trim).collect();
    let changed = text.replace(from, to);
    assert_ne!(text, changed, "{case}: nothing is replaced");
    std::fs::write(folder.join("bad.gltf"), changed).expect("it is written");
    let mut app = app(&folder);
    spawn(&mut app, "bad.gltf", "Wind");
    run(&mut app, 10);
    std::fs::remove_dir_all(folder).expect("it is removed");
    let messages = messages(&app).to_vec();
    (app, messages)
}

#[test]
fn messages_name_the_file_the_node_and_the_key() {
    let mesh = "bad.gltf#Mesh0/Primitive0, Scene0/Flag/FlagCloth.Red: ";
    for (case, from, to, place, said) in [
        ("unknown", "ClothMaterial", "ClothMateriel", mesh, "no component ClothMateriel"),
        ("number", "0.25", "\"heavy\"", mesh, "ClothMaterial, at area_density: invalid type"),
        ("field", "area_density", "area_densitee", mesh, "unknown field `area_densitee`"),
        (
            "node",
            "\"target\": \"Halyard\"",
            "\"target\": \"Mast\"",
            mesh,
            "no node is named \"Mast\"",
        ),
        ("several", "\"Pole\"", "\"Halyard\"", mesh, "several nodes are named \"Halyard\""),
        (
            "lacks",
            ",\"vertices\": \"Rigid\"",
            "",
            mesh,
            "Attachment, at .: Attachment lacks a field",
        ),
        (
            "part",
            "\"weights\"",
            "\"max_distance\": {\"at_one\": 1.0}, \"weights\"",
            mesh,
            "ClothFromMesh, at max_distance: PaintedDistance lacks a field",
        ),
        (
            "form",
            "\"skein\": [{\"WindField\"",
            "\"skein\": [7, {\"WindField\"",
            "bad.gltf#Scene0, Scene0/Wind: ",
            "7 is no component",
        ),
        ("paint", "COLOR_0", "COLOR_1", mesh, "lacks Vertex_Color"),
    ] {
        let (mut app, messages) = import(case, from, to);
        let [message, others @ ..] = &messages[..] else { panic!("{case}: no message") };
        // An attachment whose cloth is not imported.
        assert!(others.iter().all(|it| it.contains("holds nothing")), "{case}: {others:?}");
        assert!(message.starts_with(place), "{case}: {message}");
        assert!(message.contains(said), "{case}: {message}");
        let wind = find(&mut app, "Wind").expect("a node");
        assert!(app.world().get::<WindField>(wind).is_some(), "{case}: the wind is imported");
    }
}
