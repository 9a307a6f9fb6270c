//! Sets the frame motion, gravity and air of each cloth in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{FrameMotion, Loads};

use crate::batch::batches::ClothBatches;
use crate::batch::occupancy::LaneMut;
use crate::cloth::instance::ClothInstance;
use crate::environment::surroundings::{Exposure, Surroundings, report_settings};
use crate::lod::effort::ClothEffort;
use crate::motion::inertia::ClothInertia;
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

type DrivenCloth = (
    &'static mut ClothInstance,
    &'static PoseHistory,
    &'static mut ClothEffort,
    Option<&'static ClothInertia>,
);

/// Sets frame motion, gravity and wind, along the axes of the cloth's frame at the end of the tick. A cloth feels the air
/// at its middle.
pub(crate) fn drive_cloths(
    mut cloths: Query<(DrivenCloth, Exposure)>,
    surroundings: Surroundings,
    mut batches: ResMut<ClothBatches>,
    mut winds: Local<Vec<Vec3>>,
) {
    let tick = surroundings.tick();
    let middles = cloths.iter().filter_map(|((instance, frame, ..), _)| {
        instance.lane().map(|_| frame.end() * (instance.growth.end() * instance.rest_middle))
    });
    surroundings.winds_at(middles, &mut winds);
    let mut winds = winds.iter();
    for ((mut instance, frame, mut effort, inertia), exposure) in &mut cloths {
        let Some(lane) = instance.lane() else { continue };
        let Some(wind) = winds.next() else { break };
        let motion = frame.motion();
        let mut drive = surroundings.drive(*wind, frame.end(), motion, &exposure);
        // Gravity is written in every tick, which must not mark the cloth as changed.
        let instance = instance.bypass_change_detection();
        let growth = instance.growth;
        instance.gravity = growth.drive(drive).gravity;
        let inertia = inertia.map_or_else(ClothInertia::default, |inertia| inertia.acting());
        if instance.inertia.is_some_and(|former| former != inertia) {
            replace_inertia(instance, inertia, &effort.motion(), tick, &mut batches);
        }
        instance.inertia = Some(inertia);
        if !inertia.is_full() {
            inertia.reduce(&mut drive, &effort.motion(), tick);
        }
        let drive = growth.drive(drive);
        let material = instance.acting_material();
        let fabric = instance.fabric();
        let air = fabric.map_or(0.0, |it| Loads::of_air(it, &drive, &material, tick));
        let air = air * growth.end();
        effort.note_drive(motion, air, exposure.acceleration().length(), inertia);
        let mut lane = batches.lane(lane);
        if let Some(velocity) = frame.launch() {
            let velocity = frame.end().rotation.inverse() * inertia.felt_launch(velocity, tick);
            launch(&mut lane, velocity / growth.end());
        }
        lane.drive(drive);
    }
}

/// Gives a cloth another inertia without a jolt, given the motion of its frame in the last tick of `tick` seconds.
fn replace_inertia(
    instance: &mut ClothInstance,
    inertia: ClothInertia,
    motion: &FrameMotion,
    tick: f32,
    batches: &mut ClothBatches,
) {
    let (Some(former), Some(mut state)) = (instance.inertia, instance.state(batches)) else {
        return;
    };
    let growth = &instance.growth;
    let [former, inertia] = [former, inertia].map(|inertia| growth.inertia(inertia));
    inertia.replace(former, &mut state, &growth.motion(*motion), tick);
    if state.is_finite() {
        instance.set_state(state, batches);
    }
}

/// Adds a velocity (m/s) to a cloth as a whole, so that its frame does not tear it along when it is fast from one tick to
/// the next.
fn launch(lane: &mut LaneMut, velocity: Vec3) {
    let mut state = lane.snapshot().without_history();
    state.velocities.iter_mut().for_each(|speed| *speed += velocity);
    lane.restore(&state);
}
