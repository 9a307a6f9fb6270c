//! Teleports of cloths on request.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::skeleton::joints::JointPoses;

/// Makes the next change of a cloth's frame, and of each of its anchors and joints, a teleport: the cloth moves with its frame rigidly, without being
/// accelerated. Trigger this event in the frame or tick in which the target is moved, before or after the
/// motion, but before the next tick of the cloth.
///
/// A change of velocity above [`Attachment::teleport_speed`](crate::Attachment::teleport_speed) is a teleport
/// without this event.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let entity = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// // Before the cloth's target is moved.
/// world.trigger(TeleportCloth { entity, mode: TeleportMode::Keep });
/// ```
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct TeleportCloth {
    /// The cloth.
    pub entity: Entity,
    /// Whether the cloth keeps its shape.
    pub mode: TeleportMode,
}

/// What becomes of a cloth's shape when it is teleported: how it gets there is always the same, at once.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let entity = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// // The figure appears elsewhere, its cape at rest.
/// world.trigger(TeleportCloth { entity, mode: TeleportMode::Reset });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum TeleportMode {
    /// The cloth keeps its shape and its velocities relative to its frame.
    #[default]
    Keep,
    /// The cloth is reset to its shape at rest, without velocity; that of a [`ClothSkin`](crate::ClothSkin) to the pose of
    /// its skeleton.
    Reset,
}

/// Handles [`TeleportCloth`].
#[derive(Debug, Default)]
pub struct TeleportPlugin;

impl Plugin for TeleportPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<TeleportMode>().add_observer(teleport);
    }
}

type TeleportedCloth = (
    &'static mut PoseHistory,
    Option<&'static mut AnchorPoses>,
    Option<&'static mut JointPoses>,
    &'static mut ClothInstance,
    &'static mut ClothState,
);

fn teleport(
    request: On<TeleportCloth>,
    mut cloths: Query<TeleportedCloth>,
    mut batches: ResMut<ClothBatches>,
    times: Res<ObservationTimes>,
) {
    let Ok((mut history, anchors, joints, mut instance, mut state)) =
        cloths.get_mut(request.entity)
    else {
        return;
    };
    history.teleport_next(&times);
    if let Some(mut anchors) = anchors {
        anchors.teleport_next(&times);
    }
    if let Some(mut joints) = joints {
        joints.snap_next(&times);
    }
    if request.mode == TeleportMode::Reset {
        instance.reset(&mut state, &mut batches);
    }
}
