//! The plugin of snapshots: what a restoration brings lasts until the end of the next tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::cloth::instance::ClothInstance;
use crate::cloth::restored::RestoredAt;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};
use crate::skeleton::joints::JointPoses;

/// Saves and restores cloths, see [`ClothSaves`](crate::ClothSaves).
#[derive(Debug, Default)]
pub struct SavePlugin;

impl Plugin for SavePlugin {
    fn build(&self, app: &mut App) {
        let was_restored = |restorations: Res<Restorations>| restorations.since_last_tick;
        app.init_resource::<Restorations>().add_systems(
            ClothTick,
            (
                turn_clocks_back
                    .before(ClothSystems::Prepare)
                    .ambiguous_with_all()
                    .run_if(was_restored),
                forget_restorations
                    .after(ClothSystems::Publish)
                    .ambiguous_with_all()
                    .run_if(was_restored),
            ),
        );
    }
}

/// Whether anything was restored since the last tick.
#[derive(Resource, Debug, Default)]
pub(super) struct Restorations {
    pub since_last_tick: bool,
}

/// Difference between two readings of a clock that is rounding, s.
const ROUNDING: f64 = 1e-6;

/// Turns all times back where the tick begins before the end of the last one: the app restores its clock, too.
fn turn_clocks_back(
    time: Res<Time>,
    mut times: ResMut<ObservationTimes>,
    mut histories: Query<&mut PoseHistory>,
    mut anchors: Query<&mut AnchorPoses>,
    mut joints: Query<&mut JointPoses>,
) {
    let begin = time.elapsed().saturating_sub(time.delta()).as_secs_f64();
    let by = begin - times.tick;
    if by > -ROUNDING {
        return;
    }
    let from = *times;
    times.frame += by;
    times.tick = begin;
    let to = *times;
    for mut history in &mut histories {
        history.bypass_change_detection().move_times(&from, &to);
    }
    anchors.iter_mut().for_each(|mut poses| poses.move_times(&from, &to));
    joints.iter_mut().for_each(|mut poses| poses.move_times(&from, &to));
}

/// What has changed counts from the end of this tick on.
fn forget_restorations(
    mut instances: Query<&mut ClothInstance>,
    mut histories: Query<&mut PoseHistory>,
    mut restorations: ResMut<Restorations>,
) {
    for mut instance in &mut instances {
        instance.bypass_change_detection().restored = None;
    }
    for mut history in &mut histories {
        history.bypass_change_detection().note_restored(RestoredAt::default());
    }
    restorations.since_last_tick = false;
}
