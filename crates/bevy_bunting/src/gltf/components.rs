//! Components in the `extras` of glTF files.

use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent, ReflectResource};
use bevy_gltf::{GltfExtras, GltfMaterialExtras, GltfMeshExtras, GltfSceneExtras};
use bevy_reflect::serde::TypedReflectDeserializer;
use bevy_reflect::{PartialReflect, TypeRegistration, TypeRegistry};
use serde::de::DeserializeSeed;
use serde_json::Value;

use crate::complete_reader::CompleteReader;
use crate::gltf::error::{GltfComponentError, GltfComponentFailed};
use crate::gltf::nodes::Nodes;

/// Key of the list of components in extras, which is that of the Blender add-on skein.
const KEY: &str = "skein";

/// Inserts the components that a scene, its nodes, meshes and materials have in their extras.
pub fn insert_components(world: &mut World, scene: Entity) {
    let entities = descendants(world, scene);
    let types = world.resource::<AppTypeRegistry>().clone();
    let types = types.read();
    let nodes = Nodes::of(world, &entities);
    for entity in entities {
        for extras in extras(world, entity) {
            for component in list(&extras) {
                let component = component.and_then(|(name, value)| {
                    let registration = find(&types, &name)?;
                    let value = read(&name, &value, registration, &types, &nodes)?;
                    Ok((registration, value))
                });
                match component {
                    Ok((registration, value)) => {
                        insert(world, entity, registration, &*value, &types);
                    }
                    Err(error) => GltfComponentFailed::report(world, entity, error),
                }
            }
        }
    }
}

/// The entities below an entity.
fn descendants(world: &World, root: Entity) -> Vec<Entity> {
    let mut found = vec![root];
    let mut next = 0;
    while let Some(&entity) = found.get(next) {
        found.extend(world.get::<Children>(entity).into_iter().flatten());
        next += 1;
    }
    found.split_off(1)
}

/// The texts of an entity's extras.
fn extras(world: &World, entity: Entity) -> Vec<String> {
    let entity = world.entity(entity);
    let texts = [
        entity.get::<GltfExtras>().map(|it| &it.value),
        entity.get::<GltfMeshExtras>().map(|it| &it.value),
        entity.get::<GltfMaterialExtras>().map(|it| &it.value),
        entity.get::<GltfSceneExtras>().map(|it| &it.value),
    ];
    texts.into_iter().flatten().cloned().collect()
}

/// The components in a text, by name; none if it lacks the key.
fn list(extras: &str) -> Vec<Result<(String, Value), GltfComponentError>> {
    let form = |reason: String| GltfComponentError::Form { reason };
    let parsed: Value = match serde_json::from_str(extras) {
        Ok(parsed) => parsed,
        Err(error) => return vec![Err(form(error.to_string()))],
    };
    let Some(components) = parsed.get(KEY) else { return Vec::new() };
    let Value::Array(components) = components else {
        return vec![Err(form(format!("{KEY} is no list")))];
    };
    let named = |component: &Value| {
        let only = component.as_object().filter(|it| it.len() == 1);
        let only = only.and_then(|it| it.iter().next());
        let (name, value) = only.ok_or_else(|| form(format!("{component} is no component")))?;
        Ok((name.clone(), value.clone()))
    };
    components.iter().map(named).collect()
}

/// The component or resource of a name, or of a whole path.
fn find<'a>(
    types: &'a TypeRegistry,
    name: &str,
) -> Result<&'a TypeRegistration, GltfComponentError> {
    let found = types.get_with_type_path(name).or_else(|| types.get_with_short_type_path(name));
    let found = found.filter(|it| it.contains::<ReflectComponent>());
    found.ok_or_else(|| GltfComponentError::Unknown { component: name.to_owned() })
}

/// A component from its JSON.
fn read(
    name: &str,
    value: &Value,
    registration: &TypeRegistration,
    types: &TypeRegistry,
    nodes: &Nodes,
) -> Result<Box<dyn PartialReflect>, GltfComponentError> {
    let mut path = serde_path_to_error::Track::new();
    let from = serde_path_to_error::Deserializer::new(value, &mut path);
    let node = |name: &str| nodes.find(name);
    let mut reader = CompleteReader::with_entities(&node);
    let seed = TypedReflectDeserializer::with_processor(registration, types, &mut reader);
    seed.deserialize(from).map_err(|error| GltfComponentError::Value {
        component: name.to_owned(),
        key: path.path().to_string(),
        reason: error.to_string(),
    })
}

/// Inserts a component into an entity, or a resource into the world.
fn insert(
    world: &mut World,
    entity: Entity,
    registration: &TypeRegistration,
    value: &dyn PartialReflect,
    types: &TypeRegistry,
) {
    let Some(component) = registration.data::<ReflectComponent>() else { return };
    let mut entity = entity;
    if registration.contains::<ReflectResource>() {
        let id = component.register_component(world);
        entity = match world.resource_entities().get(id) {
            Some(known) => known,
            None => world.spawn_empty().id(),
        };
    }
    let mut entity = world.entity_mut(entity);
    component.insert(&mut entity, value, types);
}
