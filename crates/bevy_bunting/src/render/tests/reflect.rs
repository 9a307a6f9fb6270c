//! Every component and resource that a user sets can be edited in inspectors and written into scene files.

use std::any::TypeId;
use std::collections::BTreeSet;
use std::path::Path;

use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent, ReflectResource};
use bevy_reflect::enums::VariantInfo;
use bevy_reflect::{TypeInfo, TypeRegistry};

use super::*;

/// Results, which are no part of a scene, and the types of a plugin that the user adds.
const RESULTS: [&str; 9] = [
    "ClothState",
    "ClothEffort",
    "ClothTimings",
    "ClothBatches",
    "ClothCounts",
    "ClothGizmos",
    "ClothDrag",
    "ClothDragSettings",
    "Grabbed",
];

/// Opaque values that the feature `serialize` serialises.
const SERIALIZED: [&str; 1] = ["SharedShapeReflect"];

/// The texts of all source files of the crate.
fn sources() -> Vec<String> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                texts.push(std::fs::read_to_string(path).expect("a source file"));
            }
        }
    }
    texts
}

/// Names of the public types of the crate with this derive, from its source.
pub(crate) fn public_types(derive: &str) -> BTreeSet<String> {
    let exports = include_str!("../../lib.rs");
    let exported: BTreeSet<&str> =
        exports.split(|letter: char| !letter.is_alphanumeric()).collect();
    let mut found = BTreeSet::new();
    for text in sources() {
        for declared in text.split("#[derive(").skip(1) {
            let (derives, after) = declared.split_once(")]").expect("a derive");
            if !derives.split(", ").any(|it| it.trim() == derive) {
                continue;
            }
            let kinds = ["pub struct ", "pub enum "].into_iter();
            let after = kinds.filter_map(|kind| after.split_once(kind)).min_by_key(|it| it.0.len());
            let Some((_, name)) = after else { continue };
            let name: String = name.chars().take_while(|it| it.is_alphanumeric()).collect();
            if exported.contains(&name[..]) && !RESULTS.contains(&&name[..]) {
                found.insert(name);
            }
        }
    }
    found
}

/// Checks that all values that a type contains can be serialised.
fn check_serializable(of: TypeId, types: &TypeRegistry, seen: &mut BTreeSet<TypeId>) {
    if !seen.insert(of) {
        return;
    }
    let Some(registration) = types.get(of) else { panic!("{of:?} is not registered") };
    let info = registration.type_info();
    let mut contained = Vec::new();
    match info {
        TypeInfo::Struct(info) => contained.extend(info.iter().map(|field| field.type_id())),
        TypeInfo::TupleStruct(info) => contained.extend(info.iter().map(|field| field.type_id())),
        TypeInfo::Tuple(info) => contained.extend(info.iter().map(|field| field.type_id())),
        TypeInfo::List(info) => contained.push(info.item_ty().id()),
        TypeInfo::Array(info) => contained.push(info.item_ty().id()),
        TypeInfo::Map(info) => contained.extend([info.key_ty().id(), info.value_ty().id()]),
        TypeInfo::Set(info) => contained.push(info.value_ty().id()),
        TypeInfo::Enum(info) => contained.extend(info.iter().flat_map(|variant| match variant {
            VariantInfo::Struct(fields) => {
                fields.iter().map(|field| field.type_id()).collect::<Vec<_>>()
            }
            VariantInfo::Tuple(fields) => fields.iter().map(|field| field.type_id()).collect(),
            VariantInfo::Unit(_) => Vec::new(),
        })),
        TypeInfo::Opaque(info) => {
            let is_serialized = registration.contains::<bevy_reflect::ReflectSerialize>()
                && registration.contains::<bevy_reflect::ReflectDeserialize>();
            let name = info.type_path_table().short_path();
            // Scenes write entities as numbers.
            let is_known = of == TypeId::of::<Entity>() || SERIALIZED.contains(&name);
            assert!(is_serialized || is_known, "{name} cannot be serialised");
        }
    }
    contained.into_iter().for_each(|of| check_serializable(of, types, seen));
}

#[test]
fn every_public_component_and_resource_is_reflected() {
    #[cfg_attr(not(feature = "picking"), expect(unused_mut, reason = "one plugin fewer"))]
    let mut app = app(TICK);
    #[cfg(feature = "picking")]
    app.add_plugins(crate::ClothDragPlugin);
    let types = app.world().resource::<AppTypeRegistry>().read();
    let of = |name: &String| {
        types.get_with_short_type_path(name).unwrap_or_else(|| panic!("{name} is not registered"))
    };
    let components = public_types("Component");
    assert!(components.len() >= 14, "{components:?}");
    let resources = public_types("Resource");
    assert!(resources.len() >= 3, "{resources:?}");
    let mut seen = BTreeSet::new();
    for name in &components {
        assert!(of(name).contains::<ReflectComponent>(), "{name}");
        check_serializable(of(name).type_id(), &types, &mut seen);
    }
    for name in &resources {
        assert!(of(name).contains::<ReflectResource>(), "{name}");
        check_serializable(of(name).type_id(), &types, &mut seen);
    }
}

#[test]
fn no_field_is_left_out_of_reflection() {
    let left_out = ["#[reflect(", "ignore"].concat();
    assert!(!sources().iter().any(|text| text.contains(&left_out)));
}

#[test]
fn a_cloth_of_a_mesh_makes_the_round_trip() {
    let paint = VertexPaint::Attribute("Pin".to_owned());
    let max_distance = Some(PaintedDistance { paint: paint.clone(), at_zero: 0.1, at_one: 0.5 });
    let weights = Some(PaintedWeights { paint: paint.clone(), free: 0.2, pinned: 0.7 });
    let asked = ClothFromMesh {
        repair: true,
        ignore_uv: true,
        weights,
        max_distance,
        held: vec![PaintedVertices { paint, least: 0.3 }],
        ..ClothFromMesh::default()
    };
    let mut app = app(TICK);
    let original = app.world_mut().spawn(asked.clone()).id();
    let copy = app.world_mut().spawn_empty().id();
    let types = app.world().resource::<AppTypeRegistry>().clone();
    let types = types.read();
    let component = types.get_with_short_type_path("ClothFromMesh").expect("registered");
    let component = component.data::<ReflectComponent>().expect("a component");
    let saved = component.reflect(app.world().entity(original)).expect("it has one");
    let saved = saved.as_partial_reflect().to_dynamic();
    component.insert(&mut app.world_mut().entity_mut(copy), &*saved, &types);
    assert_eq!(app.world().get::<ClothFromMesh>(copy), Some(&asked));
}

#[test]
fn names_in_scene_files_have_no_private_modules() {
    let app = app(TICK);
    let types = app.world().resource::<AppTypeRegistry>().read();
    let paths = types.iter().map(|it| it.type_info().type_path()).filter(|it| !it.contains('<'));
    let ours: Vec<&str> = paths.filter(|it| it.contains("bunting")).collect();
    assert!(ours.len() > 40, "{ours:?}");
    for path in ours {
        assert_eq!(path.matches("::").count(), 1, "{path} names a module");
    }
}
