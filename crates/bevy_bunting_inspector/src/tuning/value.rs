//! Reading of one value.

use bevy_bunting::CompleteReader;
use bevy_reflect::serde::TypedReflectDeserializer;
use bevy_reflect::{PartialReflect, TypeRegistration, TypeRegistry};
use ron::value::RawValue;
use serde::de::DeserializeSeed;

use crate::tuning::error::{Failed, TuningProblem};

/// A value of a type from its text.
pub fn read_value(
    key: String,
    text: &RawValue,
    registration: &TypeRegistration,
    types: &TypeRegistry,
) -> Result<Box<dyn PartialReflect>, Failed> {
    let mut path = serde_path_to_error::Track::new();
    let mut reader = CompleteReader::default();
    let seed = TypedReflectDeserializer::with_processor(registration, types, &mut reader);
    let read = ron::Deserializer::from_str(text.get_ron()).map_err(|error| error.code);
    let read = read.and_then(|mut from| {
        seed.deserialize(serde_path_to_error::Deserializer::new(&mut from, &mut path))
    });
    read.map_err(|error| {
        let path = path.path();
        let inner = path.iter().next().map_or_else(String::new, |_| format!(".{path}"));
        (key + &inner, TuningProblem::Value(Box::new(error)))
    })
}
