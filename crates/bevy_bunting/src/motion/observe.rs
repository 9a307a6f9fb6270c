//! Observes the frames of cloths and the poses of colliders in each frame and each tick.

use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_time::{Time, Virtual};
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::motion::attachment::{Attachment, TELEPORT_SPEED};
use crate::motion::follow::MovedEntities;
use crate::motion::frame::{frame_and_scale_of, frame_of, is_finite};
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;

/// Change of velocity above which a change of pose is a teleport if the attachment itself was changed in this
/// tick, m/s: setting another offset is no motion. Smaller: an offset that is moved continuously does not
/// swing the cloth. Larger: a change of the offset by some centimetres whips the cloth.
const EDIT_SPEED: f32 = 3.0;

type ChangedHistories<'w, 's> = Query<'w, 's, Entity, Changed<PoseHistory>>;

type Histories<'w, 's> =
    Query<'w, 's, (&'static mut PoseHistory, Option<Ref<'static, Attachment>>)>;

/// Entities with a [`PoseHistory`] that must be observed: those that may have moved, and those whose history
/// is not at rest yet.
#[derive(SystemParam)]
pub(crate) struct Observer<'w, 's> {
    moved: MovedEntities<'w, 's>,
    /// Histories that are new, were reset, moved or expect a teleport; and all histories.
    histories: ParamSet<'w, 's, (ChangedHistories<'static, 'static>, Histories<'static, 'static>)>,
    /// Entities that were not at rest when the system last ran.
    restless: Local<'s, Vec<Entity>>,
}

impl Observer<'_, '_> {
    /// Calls `observe` with each entity to be observed.
    fn for_each(
        &mut self,
        mut observe: impl FnMut(Entity, &mut PoseHistory, Option<Ref<Attachment>>),
    ) {
        let changed = self.histories.p0();
        let moved = self.moved.find(self.restless.drain(..).chain(&changed));
        let mut histories = self.histories.p1();
        for &entity in moved {
            let Ok((mut history, attachment)) = histories.get_mut(entity) else { continue };
            let (rested, ends, scale) = (history.rests(), history.ends(), history.scale());
            observe(entity, history.bypass_change_detection(), attachment);
            if !history.rests() {
                self.restless.push(entity);
            }
            // Whoever compares ticks of change sees every motion and every teleport. The end of a rest is a change too,
            // since the other observing systems must learn of it.
            if history.ends() != ends || (rested && !history.rests()) || history.scale() != scale {
                history.set_changed();
            }
        }
    }
}

/// Lets what was disabled count as moved once it no longer is: nothing was observed meanwhile, and what it follows may have moved.
pub(super) fn observe_enabled(
    enabled: On<Remove, Disabled>,
    mut followers: Query<&mut Transform, (With<PoseHistory>, Allow<Disabled>)>,
) {
    if let Ok(mut transform) = followers.get_mut(enabled.entity) {
        transform.set_changed();
    }
}

/// Observes all frames in a frame of the app; if `EARLY`, before the ticks of that frame.
pub(crate) fn observe_frames<const EARLY: bool>(
    mut observer: Observer,
    transforms: TransformHelper,
    time: Res<Time<Virtual>>,
    mut times: ResMut<ObservationTimes>,
) {
    let now = time.elapsed_secs_f64();
    observer.for_each(|entity, history, attachment| {
        let pose = frame_of(entity, attachment.as_deref(), &transforms);
        if let Some(pose) = pose.filter(is_finite) {
            let limit = teleport_speed(history, attachment);
            history.observe_frame(&times, now, pose, limit, EARLY);
        }
    });
    if !EARLY {
        times.end_frame(now);
    }
}

/// Observes all frames after the ticks of a frame of the app, before anything outside the fixed loop moves them.
pub(super) fn observe_end_of_ticks(
    mut observer: Observer,
    transforms: TransformHelper,
    times: Res<ObservationTimes>,
) {
    observer.for_each(|entity, history, attachment| {
        let pose = frame_of(entity, attachment.as_deref(), &transforms);
        if let Some(pose) = pose.filter(is_finite) {
            history.observe_end_of_ticks(&times, pose);
        }
    });
}

/// Observes all frames in a tick, from which their motion in it follows. Reports frames that are not finite.
pub(crate) fn observe_ticks(
    mut observer: Observer,
    mut instances: Query<&mut ClothInstance>,
    transforms: TransformHelper,
    time: Res<Time>,
    mut times: ResMut<ObservationTimes>,
    mut commands: Commands,
) {
    let now = times.in_tick(time.elapsed_secs_f64());
    let tick = time.delta_secs_f64();
    observer.for_each(|entity, history, attachment| {
        let observed = frame_and_scale_of(entity, attachment.as_deref(), &transforms);
        let (pose, scale) = observed.unzip();
        if let Some(scale) = scale.filter(|scale| scale.is_finite()) {
            history.observe_scale(&times, scale);
        }
        match pose.filter(is_finite) {
            Some(pose) => {
                let limit = teleport_speed(history, attachment);
                history.observe_tick(&times, &now, tick, pose, limit);
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

/// Change of velocity above which a change of pose is a teleport, m/s.
fn teleport_speed(history: &PoseHistory, attachment: Option<Ref<Attachment>>) -> f32 {
    match attachment {
        Some(it) if history.has_new(&it) => it.teleport_speed.min(EDIT_SPEED),
        Some(it) => it.teleport_speed,
        None => TELEPORT_SPEED,
    }
}
