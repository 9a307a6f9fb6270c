//! Observes the frames of cloths and the poses of colliders, in each frame and each tick.

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_time::{Time, Virtual};
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::Attachment;
use crate::motion::follow::MovedEntities;
use crate::motion::frame::{frame_of, is_finite};
use crate::motion::pose::{ObservationTimes, PoseHistory};

/// A collider that departs from its extrapolated motion by more than this was teleported, m. Smaller:
/// fast colliders push no cloth. Larger: teleported ones throw it.
const COLLIDER_TELEPORT_DISTANCE: f32 = 2.0;

type ChangedHistories<'w, 's> = Query<'w, 's, Entity, Changed<PoseHistory>>;

type Histories<'w, 's> = Query<'w, 's, (&'static mut PoseHistory, Option<&'static Attachment>)>;

/// The entities with a [`PoseHistory`] that are to be observed: those that may have moved, and those
/// that do not rest yet.
#[derive(SystemParam)]
pub(super) struct Observer<'w, 's> {
    moved: MovedEntities<'w, 's>,
    /// Histories that are new, were reset, or expect a teleport; and all.
    histories: ParamSet<'w, 's, (ChangedHistories<'static, 'static>, Histories<'static, 'static>)>,
    /// Entities that did not rest when the system last ran.
    restless: Local<'s, Vec<Entity>>,
}

impl Observer<'_, '_> {
    /// Calls `observe` with each of these entities.
    fn for_each(&mut self, mut observe: impl FnMut(Entity, &mut PoseHistory, Option<&Attachment>)) {
        let changed = self.histories.p0();
        let moved = self.moved.find(self.restless.drain(..).chain(&changed));
        let mut histories = self.histories.p1();
        for &entity in moved {
            let Ok((mut history, attachment)) = histories.get_mut(entity) else { continue };
            let rested = history.rests();
            observe(entity, history.bypass_change_detection(), attachment);
            if !history.rests() {
                self.restless.push(entity);
                // Only the end of a rest is marked as a change: the other systems that observe must learn
                // of it, whereas each of them sees a motion by itself.
                if rested {
                    history.set_changed();
                }
            }
        }
    }
}

/// Observes all frames in a frame of the app; `EARLY`, before its ticks.
pub(super) fn observe_frames<const EARLY: bool>(
    mut observer: Observer,
    transforms: TransformHelper,
    time: Res<Time<Virtual>>,
    mut times: ResMut<ObservationTimes>,
) {
    let now = time.elapsed_secs_f64();
    observer.for_each(|entity, history, attachment| {
        if let Some(pose) = frame_of(entity, attachment, &transforms).filter(is_finite) {
            history.observe_frame(&times, now, pose, teleport_distance(attachment), EARLY);
        }
    });
    if !EARLY {
        times.frame = now;
    }
}

/// Observes all frames in a tick, and so their motion in it. Reports frames that are not finite.
pub(super) fn observe_ticks(
    mut observer: Observer,
    mut instances: Query<&mut ClothInstance>,
    transforms: TransformHelper,
    time: Res<Time>,
    frames: Res<Time<Virtual>>,
    mut times: ResMut<ObservationTimes>,
    mut commands: Commands,
) {
    let now = ObservationTimes {
        frame_length: frames.delta_secs_f64(),
        tick: time.elapsed_secs_f64(),
        ticks: times.ticks.wrapping_add(1),
        ..*times
    };
    let tick = time.delta_secs_f64();
    observer.for_each(|entity, history, attachment| {
        let pose = frame_of(entity, attachment, &transforms);
        match pose.filter(is_finite) {
            Some(pose) => {
                history.observe_tick(&times, &now, tick, pose, teleport_distance(attachment));
            }
            None => history.hold(),
        }
        if let Ok(mut instance) = instances.get_mut(entity) {
            let is_bad = pose.is_some_and(|pose| !is_finite(&pose));
            if is_bad && !instance.pose_reported {
                ClothFailed::report(&mut commands, entity, ClothError::Pose { entity });
            }
            if instance.pose_reported != is_bad {
                instance.pose_reported = is_bad;
            }
        }
    });
    *times = now;
}

fn teleport_distance(attachment: Option<&Attachment>) -> f32 {
    attachment.map_or(COLLIDER_TELEPORT_DISTANCE, |attachment| attachment.teleport_distance)
}
