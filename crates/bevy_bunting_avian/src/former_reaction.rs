//! What cloth did to a collider before.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

/// What cloth did to a collider in the tick before the last one: N and N·m.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct FormerReaction {
    pub force: Vec3,
    pub torque: Vec3,
    /// Greatest speed at which the collider came towards the cloth lately, m/s.
    pub approach: f32,
}
