//! What cloth did to a collider before.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// What cloth did to a collider of a body with [`FeelsCloth`](crate::FeelsCloth) in the tick before the last one, by which
/// the body's next force is extrapolated.
///
/// The plugin inserts and writes it. It is public for rollback alone: save and restore it with the body's other components.
///
/// ```
/// use bevy_bunting_avian::FormerReaction;
/// use bevy_ecs::prelude::*;
///
/// fn saved(bodies: Query<(Entity, &FormerReaction)>) -> Vec<(Entity, FormerReaction)> {
///     bodies.iter().map(|(entity, former)| (entity, *former)).collect()
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting_avian"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct FormerReaction {
    /// N.
    pub(crate) force: Vec3,
    /// N·m.
    pub(crate) torque: Vec3,
    /// Greatest speed at which the collider came towards the cloth lately, m/s.
    pub(crate) approach: f32,
}
