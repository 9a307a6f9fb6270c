//! Whether a cloth is simulated, paused or asleep.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Stops the simulation of a cloth for as long as the entity has this component: the cloth keeps its shape,
/// moves rigidly with its frame, and costs no simulation time. When the component is removed, the cloth
/// continues with the positions and velocities that it had.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let flag = world.spawn((ClothMesh::grid(17, 17, 1.0, 1.0), ClothPaused)).id();
/// world.entity_mut(flag).remove::<ClothPaused>();
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothPaused;

/// Whether a cloth is simulated or asleep. A sleeping cloth keeps its shape, moves rigidly with its
/// frame, and costs no simulation time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum ClothActivity {
    /// The cloth is simulated.
    #[default]
    Ticking,
    /// The cloth is outside the picture of every viewer. When it comes near a picture it is simulated again,
    /// first at its coarsest level.
    OffScreen,
    /// The cloth is out of every viewer's range.
    OutOfRange,
    /// The cloth, or the entity that it inherits its `Visibility` from, is hidden; with the feature `render`.
    Hidden,
    /// The cloth has come to rest. It is simulated again when its frame, its material, the wind, gravity or a
    /// collider near it changes, or when a finer level is wanted.
    AtRest,
}
