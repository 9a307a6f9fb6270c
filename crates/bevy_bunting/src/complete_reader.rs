//! How values of reflected types are read from files that people write.

use core::any::TypeId;

use bevy_ecs::prelude::*;
use bevy_reflect::serde::{ReflectDeserializerProcessor, TypedReflectDeserializer};
use bevy_reflect::{PartialReflect, ReflectFromReflect, TypeRegistration, TypeRegistry};
use serde::de::{DeserializeSeed, Error};
use serde::{Deserialize, Deserializer};

/// A processor for [`TypedReflectDeserializer`] that refuses values that lack fields without defaults. Reflection
/// alone would put a default in the place of the whole incomplete value, without a word.
///
/// ```
/// # #[cfg(feature = "gltf")] {
/// use bevy_bunting::CompleteReader;
/// use bevy_bunting::prelude::*;
/// use bevy_reflect::TypeRegistry;
/// use bevy_reflect::serde::TypedReflectDeserializer;
/// use serde::de::DeserializeSeed;
///
/// let mut types = TypeRegistry::default();
/// types.register::<SelfCollision>();
/// let registration = types.get(core::any::TypeId::of::<SelfCollision>()).unwrap();
/// let read = |json: &str| {
///     let mut reader = CompleteReader::default();
///     TypedReflectDeserializer::with_processor(registration, &types, &mut reader)
///         .deserialize(&mut serde_json::Deserializer::from_str(json))
/// };
/// assert!(read(r#"{"thickness": 0.004}"#).is_ok());
/// # }
/// ```
#[derive(Default)]
pub struct CompleteReader<'a> {
    entities: Option<&'a EntityOfName<'a>>,
    /// The type whose value is read by reflection next.
    entered: Option<TypeId>,
}

/// The entity of a name, or the reason why there is none.
type EntityOfName<'a> = dyn Fn(&str) -> Result<Entity, String> + 'a;

impl<'a> CompleteReader<'a> {
    /// A reader of entities by their names.
    #[must_use]
    pub fn with_entities(entities: &'a EntityOfName<'a>) -> Self {
        Self { entities: Some(entities), entered: None }
    }
}

impl ReflectDeserializerProcessor for CompleteReader<'_> {
    fn try_deserialize<'de, D: Deserializer<'de>>(
        &mut self,
        registration: &TypeRegistration,
        types: &TypeRegistry,
        deserializer: D,
    ) -> Result<Result<Box<dyn PartialReflect>, D>, D::Error> {
        if let Some(entities) = self.entities
            && registration.type_id() == TypeId::of::<Entity>()
        {
            let name = String::deserialize(deserializer)?;
            let entity = entities(&name).map_err(D::Error::custom)?;
            return Ok(Ok(Box::new(entity)));
        }
        if self.entered.take() == Some(registration.type_id()) {
            return Ok(Err(deserializer));
        }
        self.entered = Some(registration.type_id());
        let seed = TypedReflectDeserializer::with_processor(registration, types, self);
        let value = seed.deserialize(deserializer)?;
        // Arrays are made by the list or the struct that they are in.
        let Some(from) = registration.data::<ReflectFromReflect>() else { return Ok(Ok(value)) };
        let made = from.from_reflect(&*value);
        let name = registration.type_info().type_path_table().short_path();
        let lacks = || D::Error::custom(format!("{name} lacks a field that has no default"));
        made.map(|made| Ok(made.into_partial_reflect())).ok_or_else(lacks)
    }
}
