//! The components and resources that a tuning file holds.

use core::any::TypeId;

use bevy_bunting::ClothSubdivision;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;

/// Parameters of a cloth. Its shape, what holds it and how it starts are none: they are set where it is made.
pub const CLOTH: [TypeId; 12] = [
    TypeId::of::<ClothMaterial>(),
    TypeId::of::<LodSet>(),
    TypeId::of::<ClothInertia>(),
    TypeId::of::<ClothAcceleration>(),
    TypeId::of::<WindInfluence>(),
    TypeId::of::<WindPerParticle>(),
    TypeId::of::<ClothPressure>(),
    TypeId::of::<SelfCollision>(),
    TypeId::of::<ClothCollision>(),
    TypeId::of::<ClothLayers>(),
    TypeId::of::<SkinLimits>(),
    TypeId::of::<ClothSubdivision>(),
];

/// Parameters of a wind that lasts.
pub const WIND: [TypeId; 4] = [
    TypeId::of::<WindField>(),
    TypeId::of::<WindRegion>(),
    TypeId::of::<WindFan>(),
    TypeId::of::<WindWake>(),
];

/// Parameters of all cloths.
pub const RESOURCES: [TypeId; 2] = [TypeId::of::<ClothSettings>(), TypeId::of::<ClothBudget>()];

/// The winds that last, with their names; a wind without a [`Name`] has an empty one.
pub fn winds(world: &mut World) -> Vec<(String, Entity)> {
    type Lasting = Or<(With<WindField>, With<WindFan>, With<WindWake>)>;
    let mut winds = world.query_filtered::<(Entity, Option<&Name>), Lasting>();
    let named = |(entity, name): (Entity, Option<&Name>)| {
        (name.map_or_else(String::new, ToString::to_string), entity)
    };
    let mut found: Vec<_> = winds.iter(world).map(named).collect();
    found.sort();
    found
}

/// The entity that holds a resource.
pub fn resource_entity(world: &World, resource: TypeId) -> Option<Entity> {
    world.resource_entities().get(world.components().get_id(resource)?)
}
