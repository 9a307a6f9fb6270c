//! Cloth that is somewhere else at once.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::motion::pose::{Observed, PoseHistory};

/// Asks that the next change of a cloth's frame be a teleport: trigger it in the frame or tick in
/// which the target is moved, before or after, but before the next tick of the cloth.
///
/// A jump that would take more than [`Attachment::teleport_speed`](crate::Attachment::teleport_speed) is one
/// without asking.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct TeleportCloth {
    /// The cloth.
    pub entity: Entity,
    /// What becomes of its shape.
    pub mode: TeleportMode,
}

/// What becomes of a cloth's shape when it is teleported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum TeleportMode {
    /// The cloth keeps its shape and its motion, both carried along.
    #[default]
    Keep,
    /// The cloth is put back to rest.
    Reset,
}

/// Teleports cloths on request.
#[derive(Debug, Default)]
pub struct TeleportPlugin;

impl Plugin for TeleportPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<TeleportMode>().add_observer(teleport);
    }
}

fn teleport(
    request: On<TeleportCloth>,
    mut cloths: Query<(&mut PoseHistory, &mut ClothInstance, &mut ClothState)>,
    mut batches: ResMut<ClothBatches>,
    observed: Res<Observed>,
) {
    let Ok((mut history, mut instance, mut state)) = cloths.get_mut(request.entity) else { return };
    history.jump_next(&observed);
    if request.mode == TeleportMode::Reset {
        instance.put_to_rest(&mut state, &mut batches);
    }
}
