//! How values in a file are read.

use core::any::TypeId;

use bevy_ecs::prelude::*;
use bevy_reflect::serde::{ReflectDeserializerProcessor, TypedReflectDeserializer};
use bevy_reflect::{PartialReflect, ReflectFromReflect, TypeRegistration, TypeRegistry};
use serde::de::{DeserializeSeed, Error};
use serde::{Deserialize, Deserializer};

use crate::gltf::nodes::Nodes;

/// Reads entities by the names of nodes, and refuses values that lack fields without defaults. Reflection alone would put
/// a default in the place of the whole incomplete value, without a word.
pub struct Reader<'a> {
    nodes: &'a Nodes,
    /// The type whose value is read by reflection next.
    entered: Option<TypeId>,
}

impl<'a> Reader<'a> {
    /// A reader for the scene of these nodes.
    pub fn new(nodes: &'a Nodes) -> Self {
        Self { nodes, entered: None }
    }
}

impl ReflectDeserializerProcessor for Reader<'_> {
    fn try_deserialize<'de, D: Deserializer<'de>>(
        &mut self,
        registration: &TypeRegistration,
        types: &TypeRegistry,
        deserializer: D,
    ) -> Result<Result<Box<dyn PartialReflect>, D>, D::Error> {
        if registration.type_id() == TypeId::of::<Entity>() {
            let name = String::deserialize(deserializer)?;
            let entity = self.nodes.find(&name).map_err(D::Error::custom)?;
            return Ok(Ok(Box::new(entity)));
        }
        if self.entered.take() == Some(registration.type_id()) {
            return Ok(Err(deserializer));
        }
        self.entered = Some(registration.type_id());
        let seed = TypedReflectDeserializer::with_processor(registration, types, self);
        let value = seed.deserialize(deserializer)?;
        let from = registration.data::<ReflectFromReflect>();
        let made = from.and_then(|from| from.from_reflect(&*value));
        let name = registration.type_info().type_path_table().short_path();
        let lacks = || D::Error::custom(format!("{name} lacks a field that has no default"));
        made.map(|made| Ok(made.into_partial_reflect())).ok_or_else(lacks)
    }
}
