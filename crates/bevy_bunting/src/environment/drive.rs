//! Sets the frame motion, gravity and air of each cloth in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bunting_solver::Loads;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::environment::surroundings::{Exposure, Surroundings, report_settings};
use crate::lod::effort::ClothEffort;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// Sets the frame motion, gravity and air of each cloth in a tick.
#[derive(Debug, Default)]
pub struct DrivePlugin;

impl Plugin for DrivePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            (
                report_settings.in_set(ClothSystems::Prepare),
                drive_cloths.in_set(ClothSystems::Drive),
            ),
        );
    }
}

type DrivenCloth = (&'static mut ClothInstance, &'static PoseHistory, &'static mut ClothEffort);

/// Sets frame motion, gravity and wind, along the axes of the cloth's frame at the end of the tick.
pub(crate) fn drive_cloths(
    mut cloths: Query<(DrivenCloth, Exposure)>,
    surroundings: Surroundings,
    mut batches: ResMut<ClothBatches>,
) {
    for ((mut instance, frame, mut effort), exposure) in &mut cloths {
        let Some(lane) = instance.lane() else { continue };
        let motion = frame.motion();
        let drive = surroundings.drive(instance.rest_middle, frame.end(), motion, &exposure);
        // Gravity is written in every tick, which must not mark the cloth as changed.
        instance.bypass_change_detection().gravity = drive.gravity;
        let air = Loads::of_air(&drive, &instance.material, surroundings.tick());
        effort.note_drive(motion, air, exposure.acceleration().length());
        batches.lane(lane).drive(drive);
    }
}
