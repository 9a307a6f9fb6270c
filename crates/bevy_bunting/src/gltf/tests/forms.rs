//! Every public component can be written in a file.

use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};

use super::*;
use crate::gltf::components::insert_components;
use crate::render::tests::reflect::public_types;

/// Each public component as an artist may write it, with the fields that have no default; `{}` is a default.
const COMPONENTS: [(&str, &str); 38] = [
    ("AnchorReactions", "{}"),
    (
        "Attachment",
        r#"{"target": "Post", "vertices": {"Corners": ["TopLeft"]}, "anchors": [
            {"target": "Post", "vertices": {"List": [8, 17]}, "hold": {"Spring": {"stiffness": 300.0}}},
            {"target": "Post", "vertices": {"Edge": "Right"}, "break_force": 40.0, "hold":
                {"Rail": {"points": [[0, 0, 0], [2, 0, 0]], "ring_mass": 0.01, "friction": 0.1}}}
        ]}"#,
    ),
    ("ClothAcceleration", "[0.0, 1.0, 0.0]"),
    ("ClothCollider", r#"{"shape": {"Ball": {"radius": 0.5}}, "margin": 0.01}"#),
    ("ClothCollision", "{}"),
    ("ClothDeformer", r#"{"cloth": "Post"}"#),
    ("ClothFeatures", "{}"),
    ("ClothFromMesh", r#"{"repair": true, "weights": {"paint": {"Attribute": "Pin"}}}"#),
    (
        "ClothGrab",
        r#"{"cloth": "Post", "vertices": {"Ball": {"centre": [0, 0, 0], "radius": 0.1}}}"#,
    ),
    ("ClothInertia", "{}"),
    ("ClothLayers", r#"{"memberships": 1, "filters": 2}"#),
    ("ClothMaterial", r#"{"area_density": 0.2, "thickness": 0.002}"#),
    ("ClothMesh", r#"{"Grid": {"columns": 9, "rows": 9, "width": 1.0, "height": 1.0}}"#),
    ("ClothPaused", "{}"),
    ("ClothPreroll", "{}"),
    ("ClothPressure", r#"{"Constant": {"pressure": 30.0}}"#),
    ("ClothReactions", "{}"),
    (
        "ClothRegions",
        r#"[{"shape": {"UvLine": {"from": [0, 0.3], "to": [1, 0.3], "width": 0.05}}, "bending": 1e4}]"#,
    ),
    ("ClothResolution", r#"{"CellSize": 0.03}"#),
    (
        "ClothSeams",
        r#"{"seams": [
            {"sides": [{"Edge": "Left"}, {"Edge": "Right"}], "closing": 1.0},
            {"sides": [{"Vertices": [0, 8]}, {"Through": [[0, 0, 0], [1, 0, 0]]}], "length": 0.02}
        ]}"#,
    ),
    ("ClothSeed", "7"),
    ("ClothSkin", r#"{"joints": ["Post"]}"#),
    ("ClothSubdivision", "{}"),
    ("ClothSurface", "{}"),
    ("GustTravel", "[0.0, 0.0, 0.0]"),
    ("LodSet", r#"{"choice": {"Distances": [10.0, 20.0]}}"#),
    ("LodViewer", "{}"),
    ("ScaleInShape", "{}"),
    ("SelfCollision", "{}"),
    ("SkinLimits", r#"{"max_distance": {"AlongV": {"top": 0.02, "bottom": 0.6}}}"#),
    ("WakeTrail", "[]"),
    ("WindBlast", "{}"),
    ("WindFan", "{}"),
    ("WindField", r#"{"velocity": [4.0, 0.0, 0.0]}"#),
    ("WindInfluence", "0.5"),
    ("WindPerParticle", "{}"),
    ("WindRegion", r#"{"shape": {"Box": {"half_extents": [2.0, 3.0, 5.0]}}, "falloff": 1.0}"#),
    ("WindWake", "{}"),
];

#[test]
fn every_public_component_can_be_written() {
    let mut app = app(&assets());
    for component in public_types("Component") {
        let known = COMPONENTS.iter().find(|(name, _)| *name == component);
        let (_, value) = known.unwrap_or_else(|| panic!("{component} has no example"));
        let world = app.world_mut();
        let scene = world.spawn_empty().id();
        world.spawn((Name::new("Post"), ChildOf(scene)));
        let value = format!(r#"{{"skein": [{{"{component}": {value}}}]}}"#);
        let cloth = world.spawn((GltfExtras { value }, ChildOf(scene))).id();
        insert_components(world, scene);
        world.flush();
        assert_eq!(messages(&app), [""; 0]);
        let types = app.world().resource::<AppTypeRegistry>().read();
        let found = types.get_with_short_type_path(&component).expect("registered");
        let found = found.data::<ReflectComponent>().expect("a component");
        assert!(found.reflect(app.world().entity(cloth)).is_some(), "{component}");
    }
}

#[test]
fn what_a_file_leaves_out_has_the_default_that_code_gives_it() {
    let mut app = app(&assets());
    let world = app.world_mut();
    let scene = world.spawn_empty().id();
    let post = world.spawn((Name::new("Post"), ChildOf(scene))).id();
    let value = r#"{"skein": [
        {"Attachment": {"vertices": "Rigid", "anchors": [{"target": "Post", "vertices": "Rigid"}]}},
        {"ClothGrab": {"cloth": "Post", "vertices": {"Ball": {"centre": [0, 0, 0], "radius": 0.1}}}},
        {"ClothCollider": {"shape": {"Ball": {"radius": 0.5}}}}
    ]}"#;
    let cloth = world.spawn((GltfExtras { value: value.to_owned() }, ChildOf(scene))).id();
    insert_components(world, scene);
    let rigid = || AttachedVertices::Rigid;
    let held = Attachment::in_place(rigid()).with_anchor(Anchor::new(post, rigid()));
    let text = |it: &dyn core::fmt::Debug| format!("{it:?}");
    let cloth = app.world().entity(cloth);
    assert_eq!(text(cloth.get::<Attachment>().expect("one")), text(&held));
    let grab = ClothGrab::within(post, 0.1);
    assert_eq!(text(cloth.get::<ClothGrab>().expect("one")), text(&grab));
    let (given, ball) = (cloth.get::<ClothCollider>().expect("one"), ClothCollider::ball(0.5));
    let numbers = |it: &ClothCollider| (it.margin, it.friction, it.features);
    assert_eq!(numbers(given), numbers(&ball));
}
