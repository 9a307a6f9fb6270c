//! Whether a cloth is simulated, paused, asleep, waiting or failed.

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

/// Whether a cloth is simulated or asleep, or what it waits for. A sleeping cloth keeps its shape, moves rigidly with its
/// frame, and costs no simulation time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
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
    /// There is no time for the cloth in the [`ClothBudget`](crate::ClothBudget), though all cloths are at their coarsest levels, and it is
    /// among the smallest in the picture. It is simulated again, first at its coarsest level, when there is.
    OverBudget,
    /// The mesh of the cloth's `ClothFromMesh`, or the bind poses of its skin, are not loaded yet; with the feature `render`.
    AwaitsAsset,
    /// Another thread is building the fabrics of a cloth that has none yet.
    AwaitsFabric,
    /// Another thread is simulating the cloth in advance, see [`ClothPreroll`](crate::ClothPreroll).
    AwaitsPreroll,
    /// The cloth cannot be simulated: a [`ClothFailed`](crate::ClothFailed) event has told why. A cloth whose components
    /// become invalid while it is simulated has not failed: it keeps its last valid state.
    Failed,
}
