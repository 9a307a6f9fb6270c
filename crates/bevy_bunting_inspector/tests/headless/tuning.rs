//! Tuning files.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;

use bevy_app::App;
use bevy_bunting::ClothSubdivision;
use bevy_bunting::bunting_solver::LaneCount;
use bevy_bunting::prelude::*;
use bevy_bunting_inspector::{TuningError, TuningProblem, load_tuning, save_tuning};
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, bits, run, spawn_flag};

/// Components that are no parameters: shapes, what holds cloth, how it starts, results, other entities, and states.
const NOT_TUNED: [&str; 29] = [
    "AnchorReactions",
    "Attachment",
    "ClothCollider",
    "ClothDeformer",
    "ClothDrag",
    "ClothDragSettings",
    "ClothFeatures",
    "ClothFromMesh",
    "ClothGizmos",
    "ClothGrab",
    "ClothMesh",
    "ClothPaused",
    "ClothPreroll",
    "ClothReactions",
    "ClothRegions",
    "ClothResolution",
    "ClothSeams",
    "ClothSeed",
    "ClothSkin",
    "ClothSurface",
    "Grabbed",
    "GustTravel",
    "LodReport",
    "LodViewer",
    "PinBrush",
    "ScaleInShape",
    "TickWind",
    "WakeTrail",
    "WindBlast",
];

/// A file of its own for each test.
pub fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// An app with a flag and a wind called Breeze.
pub fn world_with_flag() -> (App, Entity) {
    let mut app = app();
    app.world_mut().spawn((Name::new("Breeze"), WindField::steady(Vec3::new(3.0, 0.0, 1.0))));
    let flag = spawn_flag(&mut app, Vec3::Y);
    run(&mut app, 2);
    (app, flag)
}

/// Changes all that a file holds.
fn tune(app: &mut App, flag: Entity) {
    let cotton = FabricMaterial { area_density: 0.17, ..FabricMaterial::COTTON };
    let levels = LodSet { pinned: Some(1), bias: 2.0, ..LodSet::new([10.0, 30.0]) };
    let mut flag = app.world_mut().entity_mut(flag);
    flag.insert((
        ClothMaterial(cotton),
        levels,
        ClothInertia { max_speed: 4.0, ..ClothInertia::new(0.3, 0.5) },
        ClothAcceleration(Vec3::new(0.5, -0.25, 0.0)),
        WindInfluence(0.75),
        WindPerParticle,
        ClothPressure::Constant { pressure: 0.5 },
        SelfCollision { thickness: 0.004, levels: 1 },
        ClothCollision::default(),
        ClothLayers { memberships: 2, filters: 6 },
        ClothSubdivision { edge: 8.0, halvings: 1 },
    ));
    let world = app.world_mut();
    let mut winds = world.query::<&mut WindField>();
    *winds.single_mut(world).expect("a wind") =
        WindField::steady(Vec3::new(8.0, 0.0, -2.0)).with_gusts(1.5, 0.25, 7);
    let budget = ClothBudget { tick: Duration::from_micros(700), ..ClothBudget::default() };
    world.insert_resource(budget);
    let mut settings = ClothSettings { gravity: Vec3::NEG_Y, ..ClothSettings::default() };
    settings.steps.truncate(1);
    settings.lanes = Some(LaneCount::One);
    world.insert_resource(settings);
}

/// Loads a text and returns the error.
fn load(app: &mut App, flag: Entity, name: &str, text: &str) -> Result<(), TuningError> {
    let file = file(name);
    std::fs::write(&file, text).expect("a file");
    load_tuning(app.world_mut(), flag, &file)
}

fn get<C: Component + Clone>(app: &App, entity: Entity) -> C {
    app.world().get::<C>(entity).expect("a component").clone()
}

#[test]
fn what_is_saved_is_loaded_and_flies_the_same() {
    let (mut first, flag) = world_with_flag();
    tune(&mut first, flag);
    let file = file("round_trip.ron");
    save_tuning(first.world_mut(), flag, &file).expect("a file");
    let (mut second, copy) = world_with_flag();
    load_tuning(second.world_mut(), copy, &file).expect("parameters");

    assert_eq!(get::<ClothMaterial>(&first, flag), get(&second, copy));
    assert_eq!(get::<LodSet>(&first, flag), get(&second, copy));
    assert_eq!(get::<ClothInertia>(&first, flag), get(&second, copy));
    assert_eq!(get::<ClothLayers>(&first, flag), get(&second, copy));
    assert_eq!(get::<ClothPressure>(&first, flag), get(&second, copy));
    assert_eq!(get::<SelfCollision>(&first, flag), get(&second, copy));
    assert_eq!(get::<ClothSubdivision>(&first, flag), get(&second, copy));
    assert_eq!(first.world().resource::<ClothBudget>(), second.world().resource());
    assert_eq!(first.world().resource::<ClothSettings>(), second.world().resource());
    let wind = |app: &mut App| {
        let world = app.world_mut();
        *world.query::<&WindField>().single(world).expect("a wind")
    };
    assert_eq!(wind(&mut first), wind(&mut second));

    run(&mut first, 30);
    run(&mut second, 30);
    assert_eq!(bits(&first, flag), bits(&second, copy));
    let texts = [(&mut first, flag), (&mut second, copy)].map(|(app, flag)| {
        save_tuning(app.world_mut(), flag, &file).expect("a file");
        std::fs::read_to_string(&file).expect("a text")
    });
    assert_eq!(texts[0], texts[1]);
}

#[test]
fn a_part_of_the_parameters_leaves_the_others() {
    let (mut app, flag) = world_with_flag();
    tune(&mut app, flag);
    let before: ClothMaterial = get(&app, flag);
    load(&mut app, flag, "part.ron", r#"(cloth: {"WindInfluence": (0.5)})"#).expect("parameters");
    assert_eq!(get::<WindInfluence>(&app, flag), WindInfluence(0.5));
    assert_eq!(get::<ClothMaterial>(&app, flag), before);
}

#[test]
fn pins_are_saved_and_loaded_where_the_cloth_is_held() {
    let (mut app, flag) = world_with_flag();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let pins = AttachedVertices::List(vec![0, 17, 40]);
    app.world_mut().entity_mut(flag).insert(Attachment::new(pole, pins.clone()));
    let file = file("pins.ron");
    save_tuning(app.world_mut(), flag, &file).expect("a file");
    let text = std::fs::read_to_string(&file).expect("a text");
    assert!(text.contains("pins: List("), "{text}");

    let other = app.world_mut().spawn(Transform::default()).id();
    app.world_mut().entity_mut(flag).insert(Attachment::new(other, ClothEdge::Left));
    let free = app.world_mut().spawn(FLAG).id();
    for cloth in [flag, free] {
        load_tuning(app.world_mut(), cloth, &file).expect("pins");
        assert_eq!(get::<Attachment>(&app, cloth).vertices, pins);
    }
    assert_eq!(get::<Attachment>(&app, flag).target, other, "the file names no target");
    load(&mut app, flag, "edge.ron", "(pins: Edge(Top))").expect("pins");
    assert_eq!(get::<Attachment>(&app, flag).vertices, ClothEdge::Top.into());
}

#[test]
fn pins_of_another_mesh_and_no_pins_are_errors() {
    let (mut app, flag) = world_with_flag();
    let mut problem = |text: &str| {
        let error = load(&mut app, flag, "bad_pins.ron", text).expect_err(text);
        assert_eq!(error.key, "pins", "{error}");
        assert_eq!(get::<Attachment>(&app, flag).vertices, ClothEdge::Left.into());
        error.problem
    };
    let other = problem("(pins: List([3, 153]))");
    assert!(matches!(other, TuningProblem::NoVertex { vertex: 153, vertices: 153 }), "{other}");
    assert!(matches!(problem("(pins: List([]))"), TuningProblem::NoPins));
    assert!(matches!(problem("(pins: Seam)"), TuningProblem::Value(_)));
}

#[test]
fn errors_name_file_entity_and_key_and_change_nothing() {
    let (mut app, flag) = world_with_flag();
    let before: ClothMaterial = get(&app, flag);
    let good = r#""ClothMaterial": ((area_density: 9.0)),"#;
    let mut problem = |key: &str, text: &str| {
        let name = "errors.ron";
        let error = load(&mut app, flag, name, text).expect_err(text);
        assert_eq!((&error.file, error.entity, &*error.key), (&file(name), flag, key), "{error}");
        let message = error.to_string();
        assert!(message.contains("errors.ron") && message.contains(key), "{message}");
        assert!(message.contains(&flag.to_string()), "{message}");
        assert_eq!(get::<ClothMaterial>(&app, flag), before, "{text}");
        error.problem
    };
    let unknown = problem("cloth.Silk", &format!(r#"(cloth: {{{good} "Silk": ()}})"#));
    assert!(matches!(unknown, TuningProblem::Unknown));
    let no_parameter = problem("cloth.ClothSeed", r#"(cloth: {"ClothSeed": (3)})"#);
    assert!(matches!(no_parameter, TuningProblem::Unknown));
    let of_cloth = problem("resources.LodSet", r#"(resources: {"LodSet": ()})"#);
    assert!(matches!(of_cloth, TuningProblem::Unknown));
    let value = format!(r#"(cloth: {{{good} "ClothInertia": (linear: "much")}})"#);
    let value = problem("cloth.ClothInertia.linear", &value);
    assert!(matches!(value, TuningProblem::Value(_)));
    let lacking = r#"(cloth: {"LodSet": (choice: Automatic())})"#;
    assert!(matches!(problem("cloth.LodSet.choice", lacking), TuningProblem::Value(_)));
    let wind = problem("winds.Storm", &format!(r#"(cloth: {{{good}}}, winds: {{"Storm": {{}}}})"#));
    assert!(matches!(wind, TuningProblem::NoWind));
    assert!(matches!(problem(".", "(cloth: "), TuningProblem::Form(_)));
    assert!(matches!(problem(".", "(clothes: {})"), TuningProblem::Form(_)));
}

#[test]
fn no_cloth_no_file_and_winds_of_one_name_are_errors() {
    let (mut app, flag) = world_with_flag();
    let missing = load_tuning(app.world_mut(), flag, &file("missing.ron"));
    assert!(matches!(missing.expect_err("no file").problem, TuningProblem::File(_)));
    let nowhere = save_tuning(app.world_mut(), flag, &file("no_folder/flag.ron"));
    assert!(matches!(nowhere.expect_err("no folder").problem, TuningProblem::File(_)));
    let pole = app.world_mut().spawn_empty().id();
    let no_cloth = save_tuning(app.world_mut(), pole, &file("no_cloth.ron"));
    assert!(matches!(no_cloth.expect_err("a pole").problem, TuningProblem::NoCloth));
    let no_cloth = load(&mut app, pole, "no_cloth.ron", "()");
    assert!(matches!(no_cloth.expect_err("a pole").problem, TuningProblem::NoCloth));
    app.world_mut().spawn((Name::new("Breeze"), WindField::steady(Vec3::X)));
    let same = save_tuning(app.world_mut(), flag, &file("same.ron")).expect_err("two winds");
    assert!(matches!(same.problem, TuningProblem::SameName), "{same}");
    assert_eq!(same.key, "winds.Breeze");
    let same = load(&mut app, flag, "same.ron", r#"(winds: {"Breeze": {}})"#);
    assert!(matches!(same.expect_err("two winds").problem, TuningProblem::SameName));
}

#[test]
fn every_component_is_a_parameter_or_known_to_be_none() {
    let (mut app, flag) = world_with_flag();
    let types = app.world().resource::<AppTypeRegistry>().clone();
    let names: BTreeSet<String> = {
        let types = types.read();
        let components = types.iter().filter(|it| it.contains::<ReflectComponent>());
        let tables = components.map(|it| it.type_info().type_path_table());
        let own = tables.filter(|it| it.path().starts_with("bevy_bunting::"));
        own.map(|it| it.short_path().to_owned()).collect()
    };
    assert!(names.len() >= 30, "{names:?}");
    let mut unknown = Vec::new();
    for name in names.iter().filter(|name| !NOT_TUNED.contains(&&***name)) {
        let value = format!(r#"{{"{name}": 'x'}}"#);
        let sections = ["(cloth: {})", "(resources: {})", r#"(winds: {"Breeze": {}})"#];
        let found = sections.iter().any(|section| {
            let text = section.replace("{}", &value);
            let error = load(&mut app, flag, "all.ron", &text).expect_err("a wrong value");
            !matches!(error.problem, TuningProblem::Unknown)
        });
        unknown.extend((!found).then_some(name));
    }
    assert!(unknown.is_empty(), "neither parameters nor in NOT_TUNED: {unknown:?}");
}
