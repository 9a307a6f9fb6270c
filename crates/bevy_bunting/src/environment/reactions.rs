//! What cloths do to colliders: forces, contact areas, and events when cloth begins and ceases to touch.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// What cloths do to a [`ClothCollider`](crate::ClothCollider): insert this component beside it, and read it after each
/// tick. Colliders without it cost nothing for it.
///
/// [`ClothTouched`] and [`ClothParted`] are triggered on the collider.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let ball = world.spawn((ClothCollider::ball(0.3), ClothReactions::default())).id();
/// world.add_observer(|touched: On<ClothTouched>| println!("{} touches", touched.cloth));
/// // After a tick, the force of all cloth on the ball, N.
/// let force = world.get::<ClothReactions>(ball).unwrap().force;
/// # assert_eq!(force.length(), 0.0);
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothReactions {
    /// Mean force of all cloths on the collider over the last tick, N, in the world.
    pub force: Vec3,
    /// Mean torque of all cloths about the collider's position, N·m, in the world.
    pub torque: Vec3,
    /// Area of cloth that touches the collider at the end of the tick, m².
    pub area: f32,
    /// The cloths that touch, in the order of their indices.
    pub(crate) by_cloth: Vec<ClothReaction>,
}

/// What one cloth does to a collider.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothReaction {
    /// The cloth.
    #[cfg_attr(feature = "serialize", serde(with = "crate::save::entity_bits"))]
    pub cloth: Entity,
    /// Mean force on the collider over the last tick, N, in the world.
    pub force: Vec3,
    /// Mean torque about the collider's position, N·m, in the world.
    pub torque: Vec3,
    /// Area that touches the collider at the end of the tick, m².
    pub area: f32,
}

impl ClothReactions {
    /// The cloths that touch the collider, with what each of them does to it. A cloth that sleeps at rest does what it
    /// did before it fell asleep.
    #[must_use]
    pub fn by_cloth(&self) -> &[ClothReaction] {
        &self.by_cloth
    }

    /// Whether a cloth touches the collider.
    #[must_use]
    pub fn touches(&self, cloth: Entity) -> bool {
        self.by_cloth.iter().any(|reaction| reaction.cloth == cloth)
    }
}

/// A cloth has begun to touch a collider that has [`ClothReactions`].
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothTouched {
    /// The collider.
    pub entity: Entity,
    /// The cloth.
    pub cloth: Entity,
}

/// A cloth has ceased to touch a collider that has [`ClothReactions`], or was removed.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothParted {
    /// The collider.
    pub entity: Entity,
    /// The cloth.
    pub cloth: Entity,
}
