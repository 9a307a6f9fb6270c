//! Writing of parameters.

use core::any::TypeId;
use std::collections::BTreeMap;
use std::path::Path;

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_reflect::serde::TypedReflectSerializer;
use bevy_reflect::{PartialReflect, TypeRegistry};
use ron::ser::PrettyConfig;
use serde::{Serialize, Serializer};

use crate::parameters::{CLOTH, RESOURCES, WIND, resource_entity, winds};
use crate::tuning::error::{Failed, TuningError, TuningProblem};

/// The values of one entity, by the paths of their types.
type Values<'a> = BTreeMap<&'a str, TypedReflectSerializer<'a>>;

/// The content of a file.
#[derive(Serialize)]
struct Written<'a> {
    cloth: Values<'a>,
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "present")]
    pins: Option<TypedReflectSerializer<'a>>,
    winds: BTreeMap<&'a str, Values<'a>>,
    resources: Values<'a>,
}

/// Writes a value that is there, without RON's `Some`.
fn present<S: Serializer>(
    value: &Option<TypedReflectSerializer>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match value {
        Some(value) => value.serialize(serializer),
        None => serializer.serialize_none(),
    }
}

/// Writes the parameters of a cloth, of the winds that last and of all cloths to a file of RON, with every field.
///
/// Parameters are [`ClothMaterial`](bevy_bunting::ClothMaterial), [`LodSet`](bevy_bunting::LodSet) and the other
/// components by which a cloth is tuned; not its shape. Of its [`Attachment`] the vertices are written, as `pins`,
/// not the target. Winds are told apart by their [`Name`]; one may have none.
///
/// # Errors
///
/// [`TuningProblem::NoCloth`], [`TuningProblem::SameName`], and [`TuningProblem::File`] if the file cannot be written.
///
/// ```no_run
/// use std::path::Path;
///
/// use bevy_bunting_inspector::{TuningError, load_tuning, save_tuning};
/// use bevy_ecs::prelude::*;
///
/// fn copy(world: &mut World, from: Entity, to: Entity) -> Result<(), TuningError> {
///     let file = Path::new("flag.tuning.ron");
///     save_tuning(world, from, file)?;
///     load_tuning(world, to, file)
/// }
/// ```
pub fn save_tuning(world: &mut World, cloth: Entity, file: &Path) -> Result<(), TuningError> {
    let written = text(world, cloth).and_then(|text| {
        std::fs::write(file, text).map_err(|error| (String::new(), TuningProblem::from(error)))
    });
    written.map_err(|failed| TuningError::new(file, cloth, failed))
}

/// The text of a file.
fn text(world: &mut World, cloth: Entity) -> Result<String, Failed> {
    if world.get::<ClothMesh>(cloth).is_none() {
        return Err((String::new(), TuningProblem::NoCloth));
    }
    let found = winds(world);
    let types = world.resource::<AppTypeRegistry>().read();
    let mut written = Written {
        cloth: values(world, cloth, &CLOTH, &types),
        pins: world.get::<Attachment>(cloth).map(|it| pins(it, &types)),
        winds: BTreeMap::new(),
        resources: BTreeMap::new(),
    };
    for (name, wind) in &found {
        let of_wind = values(world, *wind, &WIND, &types);
        if written.winds.insert(name, of_wind).is_some() {
            return Err((format!("winds.{name}"), TuningProblem::SameName));
        }
    }
    for resource in RESOURCES {
        if let Some(holder) = resource_entity(world, resource) {
            written.resources.extend(values(world, holder, &[resource], &types));
        }
    }
    let text = ron::ser::to_string_pretty(&written, PrettyConfig::new());
    text.map_err(|error| (String::new(), TuningProblem::Value(Box::new(error))))
}

/// The values of an entity that are among parameters.
fn values<'a>(
    world: &'a World,
    entity: Entity,
    parameters: &[TypeId],
    types: &'a TypeRegistry,
) -> Values<'a> {
    let value = |&parameter: &TypeId| {
        let registration = types.get(parameter)?;
        let value = registration.data::<ReflectComponent>()?.reflect(world.entity(entity))?;
        let written = TypedReflectSerializer::new(value.as_partial_reflect(), types);
        Some((registration.type_info().type_path(), written))
    };
    parameters.iter().filter_map(value).collect()
}

/// The vertices of an attachment.
fn pins<'a>(attachment: &'a Attachment, types: &'a TypeRegistry) -> TypedReflectSerializer<'a> {
    TypedReflectSerializer::new(attachment.vertices.as_partial_reflect(), types)
}
