//! The shapes of colliders in the units of cloths that have grown.

use std::collections::HashMap;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use parry3d::shape::SharedShape;

use crate::environment::scaled_shape::ScaledShape;

/// The shapes of the colliders near cloths that have grown, for each cloth and collider. A collider that grows with a cloth keeps
/// its shape; of another one each tick of growth makes a new one, which replaces the last.
#[derive(Default)]
pub(super) struct ShapesInUnits(HashMap<(Entity, Entity), Kept>);

#[derive(Default)]
struct Kept {
    shape: ScaledShape,
    /// Whether it is one of this tick.
    is_used: bool,
}

impl ShapesInUnits {
    /// The shape of a collider, given its own and the scale in the units of a cloth.
    pub fn shape<'a>(
        &'a mut self,
        cloth_and_collider: (Entity, Entity),
        own: &'a SharedShape,
        scale: Vec3,
    ) -> &'a SharedShape {
        let kept = self.0.entry(cloth_and_collider).or_default();
        kept.is_used = true;
        // What cannot be scaled here was refused in the world.
        let _ = kept.shape.set(own, scale);
        kept.shape.of(own)
    }

    /// Drops the shapes that this tick has not used.
    pub fn end_tick(&mut self) {
        self.0.retain(|_, kept| core::mem::take(&mut kept.is_used));
    }
}
