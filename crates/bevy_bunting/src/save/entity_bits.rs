//! Entities as their bits, which Bevy serialises with a feature only.

use bevy_ecs::entity::Entity;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

pub fn serialize<S: Serializer>(entity: &Entity, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u64(entity.to_bits())
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Entity, D::Error> {
    let bits = u64::deserialize(deserializer)?;
    Entity::try_from_bits(bits).ok_or_else(|| D::Error::custom("no entity has these bits"))
}
