//! Sets what acts on each cloth in a tick: its frame's motion, gravity and air.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bunting_solver::{Drive, FrameMotion};

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::environment::wind::TickWind;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Sets what acts on each cloth in a tick.
#[derive(Debug, Default)]
pub struct DrivePlugin;

impl Plugin for DrivePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(ClothTick, drive_cloths.in_set(ClothSystems::Drive));
    }
}

/// Sets frame motion, gravity and wind. Gravity and wind are given in the world, and rotated to the axes
/// of the cloth's frame at the end of the tick.
pub(crate) fn drive_cloths(
    mut cloths: Query<(&mut ClothInstance, &PoseHistory)>,
    settings: Res<ClothSettings>,
    wind: Res<TickWind>,
    mut batches: ResMut<ClothBatches>,
) {
    for (mut instance, frame) in &mut cloths {
        let Some(lane) = instance.lane() else { continue };
        let (start, end) = (frame.start(), frame.end());
        let inverse = end.rotation.inverse();
        let gravity = inverse * settings.gravity;
        // Written in every tick: it must not mark the cloth as changed.
        instance.bypass_change_detection().gravity = gravity;
        batches.lane(lane).drive(Drive {
            motion: FrameMotion::between(pose_parts(start), pose_parts(end)),
            gravity,
            wind: inverse * wind.0,
            air_density: settings.air_density,
        });
    }
}

/// Translation (m) and rotation of a pose.
pub(super) fn pose_parts(pose: Isometry3d) -> (Vec3, Quat) {
    (pose.translation.into(), pose.rotation)
}
