//! Reading of parameters.

use core::any::TypeId;
use std::collections::BTreeMap;
use std::path::Path;

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_reflect::{PartialReflect, TypeRegistry};
use ron::value::RawValue;
use serde::{Deserialize, Deserializer};

use crate::parameters::{CLOTH, RESOURCES, WIND, resource_entity, winds};
use crate::tuning::error::{Failed, TuningError, TuningProblem};
use crate::tuning::pins::{hold, read_pins};
use crate::tuning::value::read_value;

/// The texts of the values of one entity, by the names of their types.
type Texts<'a> = BTreeMap<String, &'a RawValue>;

/// The content of a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Read<'a> {
    #[serde(default, borrow)]
    cloth: Texts<'a>,
    #[serde(default, borrow, deserialize_with = "present")]
    pins: Option<&'a RawValue>,
    #[serde(default, borrow)]
    winds: BTreeMap<String, Texts<'a>>,
    #[serde(default, borrow)]
    resources: Texts<'a>,
}

/// A value that is there, without RON's `Some`.
fn present<'de, D: Deserializer<'de>>(from: D) -> Result<Option<&'de RawValue>, D::Error> {
    <&RawValue>::deserialize(from).map(Some)
}

/// All values of a file.
struct Changes<'a> {
    components: Vec<Change<'a>>,
    pins: Option<AttachedVertices>,
}

/// A value that has been read, for an entity.
struct Change<'a> {
    entity: Entity,
    component: &'a ReflectComponent,
    value: Box<dyn PartialReflect>,
}

/// Reads parameters from a file that [`save_tuning`](crate::save_tuning) or a text editor has written, and gives them
/// to a cloth, the winds of the same names, and all cloths. Pins become the vertices of the cloth's [`Attachment`]; a
/// cloth without one gets one to its own `Transform`.
///
/// A file may hold any part of the parameters: the others stay as they are. Of a component that is written, fields with
/// defaults may be left out, and then have these. Types may be written by their names alone, such as `LodSet`. Values that
/// are read but cannot be simulated are reported as [`ClothFailed`](bevy_bunting::ClothFailed) in the next tick.
///
/// # Errors
///
/// All [`TuningProblem`]s; nothing in the world has changed then.
pub fn load_tuning(world: &mut World, cloth: Entity, file: &Path) -> Result<(), TuningError> {
    let failed = |failed| TuningError::new(file, cloth, failed);
    let text =
        std::fs::read_to_string(file).map_err(|error| failed((String::new(), error.into())))?;
    let types = world.resource::<AppTypeRegistry>().clone();
    let types = types.read();
    let Changes { components, pins } = changes(world, cloth, &text, &types).map_err(failed)?;
    for change in components {
        let mut entity = world.entity_mut(change.entity);
        change.component.insert(&mut entity, &*change.value, &types);
    }
    if let Some(pins) = pins {
        hold(world, cloth, pins);
    }
    Ok(())
}

/// All values of a text.
fn changes<'a>(
    world: &mut World,
    cloth: Entity,
    text: &str,
    types: &'a TypeRegistry,
) -> Result<Changes<'a>, Failed> {
    let Some(mesh) = world.get::<ClothMesh>(cloth).cloned() else {
        return Err((String::new(), TuningProblem::NoCloth));
    };
    let read: Read = ron::from_str(text)
        .map_err(|error| (String::new(), TuningProblem::Form(Box::new(error))))?;
    let found = winds(world);
    let mut changes = Vec::new();
    for (name, value) in &read.cloth {
        let key = format!("cloth.{name}");
        changes.push(change(key, name, value, &CLOTH, types, |_| Ok(cloth))?);
    }
    for (wind, values) in &read.winds {
        let mut same = found.iter().filter(|(name, _)| name == wind);
        let (first, second) = (same.next(), same.next());
        let key = || format!("winds.{wind}");
        let &(_, entity) = first.ok_or_else(|| (key(), TuningProblem::NoWind))?;
        if second.is_some() {
            return Err((key(), TuningProblem::SameName));
        }
        for (name, value) in values {
            let key = format!("winds.{wind}.{name}");
            changes.push(change(key, name, value, &WIND, types, |_| Ok(entity))?);
        }
    }
    for (name, value) in &read.resources {
        let holder = |id| resource_entity(world, id).ok_or(TuningProblem::NoResource);
        let key = format!("resources.{name}");
        changes.push(change(key, name, value, &RESOURCES, types, holder)?);
    }
    let pins = read.pins.map(|text| read_pins(text, &mesh, types)).transpose()?;
    Ok(Changes { components: changes, pins })
}

/// A value from its text: of the type of a name that is among parameters, for the entity that holds the type.
fn change<'a>(
    key: String,
    name: &str,
    text: &RawValue,
    parameters: &[TypeId],
    types: &'a TypeRegistry,
    holder: impl FnOnce(TypeId) -> Result<Entity, TuningProblem>,
) -> Result<Change<'a>, Failed> {
    let found = types.get_with_type_path(name).or_else(|| types.get_with_short_type_path(name));
    let found = found.filter(|it| parameters.contains(&it.type_id()));
    let found = found.and_then(|it| Some((it, it.data::<ReflectComponent>()?)));
    let Some((registration, component)) = found else { return Err((key, TuningProblem::Unknown)) };
    let entity = match holder(registration.type_id()) {
        Ok(entity) => entity,
        Err(problem) => return Err((key, problem)),
    };
    let value = read_value(key, text, registration, types)?;
    Ok(Change { entity, component, value })
}
