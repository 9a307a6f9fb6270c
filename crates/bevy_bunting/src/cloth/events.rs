//! Events that are triggered on cloths.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::cloth::error::ClothError;
use crate::cloth::place::place;
use crate::motion::attachment::TargetLost;

/// A cloth cannot be simulated or shown as asked, or a wind, a collider or an attachment does not do what it says. Triggered
/// on the entity that has it, and logged, once, when the error is found.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut app = App::new();
/// app.add_observer(|failed: On<ClothFailed>| println!("{}", failed.error));
/// ```
#[derive(EntityEvent, Clone, Copy, Debug)]
pub struct ClothFailed {
    /// The cloth, or the entity with the wind, the collider or the attachment.
    pub entity: Entity,
    /// The reason; its message says what to do.
    pub error: ClothError,
}

impl ClothFailed {
    /// Logs the error and triggers the event.
    pub(crate) fn report(commands: &mut Commands, entity: Entity, error: ClothError) {
        let failed = Self { entity, error };
        commands.queue(move |world: &mut World| {
            log::error!("{}", failed.message(world));
            world.trigger(failed);
        });
    }

    /// The error's message as it is logged: after the file that the cloth is from, if it is from one, and the names of the
    /// cloth's entity and of all above it, if they have any.
    #[must_use]
    pub fn message(&self, world: &World) -> String {
        format!("{}{}", place(world, self.entity), self.error)
    }
}

/// A cloth has changed its level of detail.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothLevelChanged {
    /// The cloth.
    pub entity: Entity,
    /// The level before; 0 is the finest.
    pub from: usize,
    /// The level from now on.
    pub to: usize,
}

/// An [`Anchor`](crate::Anchor) of a cloth was torn off: the cloth pulled with more than its
/// [`break_force`](crate::Anchor::break_force). Triggered on the cloth.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct ClothAnchorBroke {
    /// The cloth.
    pub entity: Entity,
    /// The target of the anchor.
    pub target: Entity,
    /// Index that the anchor had in [`Attachment::anchors`](crate::Attachment::anchors) in the tick in which it broke.
    pub anchor: usize,
    /// The force, N, in the world.
    pub force: Vec3,
}

/// The target of a cloth's [`Attachment`](crate::Attachment) was despawned. Triggered once.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothTargetLost {
    /// The cloth.
    pub entity: Entity,
    /// The target that no longer exists.
    pub target: Entity,
    /// Whether the cloth was frozen or released.
    pub outcome: TargetLost,
}
