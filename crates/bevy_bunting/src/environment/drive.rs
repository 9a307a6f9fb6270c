//! Sets the frame motion, gravity and air of each cloth in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bunting_solver::{Drive, Loads};

use crate::batch::batches::ClothBatches;
use crate::batch::occupancy::LaneMut;
use crate::cloth::instance::ClothInstance;
use crate::environment::wind::TickWind;
use crate::lod::effort::ClothEffort;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Sets the frame motion, gravity and air of each cloth in a tick.
#[derive(Debug, Default)]
pub struct DrivePlugin;

impl Plugin for DrivePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(ClothTick, drive_cloths.in_set(ClothSystems::Drive));
    }
}

/// Sets frame motion, gravity and wind. Gravity and wind are rotated from the world's axes to those of the
/// cloth's frame at the end of the tick.
pub(crate) fn drive_cloths(
    mut cloths: Query<(&mut ClothInstance, &PoseHistory, &mut ClothEffort)>,
    settings: Res<ClothSettings>,
    wind: Res<TickWind>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
) {
    let (gravity, air_density) = gravity_and_air(&settings);
    for (mut instance, frame, mut effort) in &mut cloths {
        let Some(lane) = instance.lane() else { continue };
        let end = frame.end();
        let inverse = end.rotation.inverse();
        let gravity = inverse * gravity;
        // Gravity is written in every tick, which must not mark the cloth as changed.
        instance.bypass_change_detection().gravity = gravity;
        let middle = end * instance.rest_middle;
        let drive =
            Drive { motion: frame.motion(), gravity, wind: inverse * wind.at(middle), air_density };
        let air = Loads::of_air(&drive, &instance.material, time.delta_secs());
        effort.note_drive(drive.motion, air);
        let mut lane = batches.lane(lane);
        if let Some(velocity) = frame.launch() {
            launch(&mut lane, inverse * velocity);
        }
        lane.drive(drive);
    }
}

/// Adds a velocity (m/s) to a cloth as a whole, so that its frame does not tear it along when it is fast from one tick to
/// the next.
fn launch(lane: &mut LaneMut, velocity: Vec3) {
    let mut state = lane.snapshot().without_history();
    state.velocities.iter_mut().for_each(|speed| *speed += velocity);
    lane.restore(&state);
}

/// Gravity (m/s²) and the density of the air (kg/m³). A value that is not finite, or a negative density,
/// counts as zero and is logged whenever the settings change.
fn gravity_and_air(settings: &Res<ClothSettings>) -> (Vec3, f32) {
    let (gravity, air_density) = (settings.gravity, settings.air_density);
    let is_gravity = gravity.is_finite();
    let is_density = air_density >= 0.0 && air_density.is_finite();
    if settings.is_changed() && !(is_gravity && is_density) {
        log::error!(
            "ClothSettings: gravity {gravity} and air density {air_density} must be finite, and the density not negative; an invalid value counts as zero"
        );
    }
    (if is_gravity { gravity } else { Vec3::ZERO }, if is_density { air_density } else { 0.0 })
}
