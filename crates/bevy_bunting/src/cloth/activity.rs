//! Whether a cloth is simulated, paused or asleep.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Stops a cloth for as long as the entity has this component: the cloth keeps its shape, moves
/// rigidly with its frame, and costs no simulation time. When it is removed the cloth continues with
/// the positions and velocities that it had.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothPaused;

/// Whether a cloth is simulated or asleep. A sleeping cloth keeps its shape, moves rigidly with its
/// frame, and costs no simulation time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum ClothActivity {
    /// The cloth is simulated.
    #[default]
    Ticking,
    /// The cloth is outside the picture of every viewer. It is simulated again, first at its coarsest
    /// level, when it comes near one.
    OffScreen,
    /// The cloth is out of every viewer's range.
    OutOfRange,
    /// The cloth has come to rest. It is simulated again when anything changes that acts on it: its
    /// frame, its material, the wind, gravity, a collider near it; or when a finer level is wanted.
    AtRest,
}
