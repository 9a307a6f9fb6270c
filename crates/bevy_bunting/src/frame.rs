//! The frame that each cloth lives in: observed wherever it may be moved, and drawn where it is.

use bevy_app::prelude::*;
use bevy_app::{AnimationSystems, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::hierarchy::{ChildOf, Children};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::TransformSystems;
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

use crate::attachment::{AttachedVertices, Attachment, ClothCorner, ClothEdge, TargetLost};
use crate::drive::drive_cloths;
use crate::error::{ClothError, ClothFailed};
use crate::instance::ClothInstance;
use crate::mesh::ClothMesh;
use crate::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// A collider that leaves its course by more than this was teleported, m.
const COLLIDER_TELEPORT_DISTANCE: f32 = 2.0;

/// Follows the targets of attachments, and places cloths on them.
#[derive(Debug, Default)]
pub struct AttachmentPlugin;

impl Plugin for AttachmentPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Attachment>()
            .register_type::<AttachedVertices>()
            .register_type::<ClothEdge>()
            .register_type::<ClothCorner>()
            .register_type::<TargetLost>()
            .add_systems(
                RunFixedMainLoop,
                observe_frames::<true>.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                ClothTick,
                (
                    observe_ticks.in_set(ClothSystems::Drive).before(drive_cloths),
                    place_cloths.in_set(ClothSystems::Publish),
                ),
            )
            .add_systems(
                PostUpdate,
                (observe_frames::<false>, place_cloths)
                    .chain()
                    .after(AnimationSystems)
                    .before(TransformSystems::Propagate),
            );
    }
}

type Followers<'w, 's> =
    Query<'w, 's, (Entity, &'static mut PoseHistory, Option<Ref<'static, Attachment>>)>;

type MayHaveMoved = Or<(Changed<Transform>, Changed<ChildOf>)>;

/// Tells what stands where it stood when the system last ran: much less work than to ask where.
#[derive(SystemParam)]
struct Stillness<'w, 's> {
    changed: Query<'w, 's, Entity, MayHaveMoved>,
    orphans: RemovedComponents<'w, 's, ChildOf>,
    children: Query<'w, 's, &'static Children>,
    /// What has moved, and all that hangs on it.
    moved: Local<'s, EntityHashSet>,
    open: Local<'s, Vec<Entity>>,
}

impl Stillness<'_, '_> {
    /// Finds out what has moved; to be called once, before anything is asked.
    fn note(&mut self) {
        self.moved.clear();
        self.open.extend(self.changed.iter());
        self.open.extend(self.orphans.read());
        while let Some(entity) = self.open.pop() {
            if self.moved.insert(entity)
                && let Ok(children) = self.children.get(entity)
            {
                self.open.extend(children.iter());
            }
        }
    }

    /// Whether neither the entity nor any that it hangs on was moved.
    fn of(&self, entity: Entity) -> bool {
        !self.moved.contains(&entity)
    }
}

/// Notes where everything is in a frame; `EARLY`, before its ticks.
fn observe_frames<const EARLY: bool>(
    mut followers: Followers,
    transforms: TransformHelper,
    mut stillness: Stillness,
    time: Res<Time<Virtual>>,
) {
    stillness.note();
    let now = time.elapsed_secs_f64();
    for (entity, mut history, attachment) in &mut followers {
        let pose = rest_of(entity, &history, attachment.as_ref(), &stillness);
        let attachment = attachment.as_deref();
        let pose = pose.or_else(|| frame_of(entity, attachment, &transforms).filter(is_finite));
        if let Some(pose) = pose {
            history.observe_frame(now, pose, teleport_distance(attachment), EARLY);
        }
    }
}

/// Notes where everything is in a tick, and so how it moves in it.
fn observe_ticks(
    mut followers: Followers,
    mut instances: Query<&mut ClothInstance>,
    transforms: TransformHelper,
    mut stillness: Stillness,
    time: Res<Time>,
    frames: Res<Time<Virtual>>,
    mut commands: Commands,
) {
    stillness.note();
    let (now, tick, frame) =
        (time.elapsed_secs_f64(), time.delta_secs_f64(), frames.delta_secs_f64());
    for (entity, mut history, attachment) in &mut followers {
        let rest = rest_of(entity, &history, attachment.as_ref(), &stillness);
        let attachment = attachment.as_deref();
        if let Some(pose) = rest {
            history.observe_tick(now, tick, frame, pose, teleport_distance(attachment));
            continue;
        }
        let pose = frame_of(entity, attachment, &transforms);
        match pose.filter(is_finite) {
            Some(pose) => {
                history.observe_tick(now, tick, frame, pose, teleport_distance(attachment))
            }
            None => history.stay(),
        }
        if let Ok(mut instance) = instances.get_mut(entity) {
            let bad = pose.is_some_and(|pose| !is_finite(&pose));
            if bad && !instance.pose_reported {
                ClothFailed::report(&mut commands, entity, ClothError::Pose { entity });
            }
            if instance.pose_reported != bad {
                instance.pose_reported = bad;
            }
        }
    }
}

type Placed = (Entity, Option<Ref<'static, Attachment>>, Option<&'static ChildOf>);

type Standing<'w, 's> = (TransformHelper<'w, 's>, Stillness<'w, 's>);

type Written<'w, 's> = Query<'w, 's, (&'static mut Transform, &'static mut GlobalTransform)>;

/// Writes the transforms of attached cloths: where their targets are now, whatever the last tick
/// saw.
fn place_cloths(
    cloths: Query<Placed, With<ClothMesh>>,
    mut transforms: ParamSet<(Standing, Written)>,
    mut placed: Local<Vec<(Entity, Option<Transform>, GlobalTransform)>>,
) {
    let (current, mut stillness) = transforms.p0();
    stillness.note();
    placed.clear();
    placed.extend(cloths.iter().filter_map(|(entity, attachment, parent)| {
        let parent = parent.map(ChildOf::parent);
        let target = attachment.as_ref().and_then(|it| it.target_other_than(entity));
        let unchanged = attachment.as_ref().is_none_or(|attachment| !attachment.is_changed());
        if unchanged && stillness.of(entity) && target.is_none_or(|target| stillness.of(target)) {
            return None;
        }
        match attachment
            .as_deref()
            .and_then(|attachment| Some((attachment, attachment.target_other_than(entity)?)))
        {
            Some((attachment, target)) => {
                let target_pose = current.compute_global_transform(target).ok()?;
                let frame = frame_on(&target_pose, &attachment.offset);
                let global = GlobalTransform::from_isometry(frame);
                let local = match parent {
                    // Exactly the offset, whatever the target does.
                    Some(parent) if parent == target => {
                        Transform { scale: target_pose.scale().recip(), ..attachment.offset }
                    }
                    Some(parent) => {
                        global.reparented_to(&current.compute_global_transform(parent).ok()?)
                    }
                    None => Transform::from_isometry(frame),
                };
                (local.is_finite() && global.affine().is_finite()).then_some((
                    entity,
                    Some(local),
                    global,
                ))
            }
            None => Some((entity, None, current.compute_global_transform(entity).ok()?)),
        }
    }));
    let mut written = transforms.p1();
    for (entity, local, global) in placed.drain(..) {
        if let Ok((mut transform, mut global_transform)) = written.get_mut(entity) {
            if let Some(local) = local {
                transform.set_if_neq(local);
            }
            global_transform.set_if_neq(global);
        }
    }
}

/// The pose of a cloth's frame, or a collider's, if it rests and nothing has moved it.
fn rest_of(
    entity: Entity,
    history: &PoseHistory,
    attachment: Option<&Ref<Attachment>>,
    stillness: &Stillness,
) -> Option<Isometry3d> {
    let rest = history.rest()?;
    let followed = attachment.and_then(|attachment| attachment.target_other_than(entity));
    let attached = attachment.is_none_or(|attachment| !attachment.is_changed());
    (attached && stillness.of(followed.unwrap_or(entity))).then_some(rest)
}

/// The pose of a cloth's frame, or a collider's, as its entity or target stands now. None if the
/// target is gone.
fn frame_of(
    entity: Entity,
    attachment: Option<&Attachment>,
    transforms: &TransformHelper,
) -> Option<Isometry3d> {
    let (followed, offset) = match attachment {
        Some(attachment) => match attachment.target_other_than(entity) {
            Some(target) => (target, attachment.offset),
            None => (entity, Transform::IDENTITY),
        },
        None => (entity, Transform::IDENTITY),
    };
    Some(frame_on(&transforms.compute_global_transform(followed).ok()?, &offset))
}

/// A target's pose times the offset. The target's scale moves the offset only.
fn frame_on(target: &GlobalTransform, offset: &Transform) -> Isometry3d {
    let rotation = (target.rotation() * offset.rotation).normalize();
    Isometry3d::new(target.transform_point(offset.translation), rotation)
}

fn teleport_distance(attachment: Option<&Attachment>) -> f32 {
    attachment.map_or(COLLIDER_TELEPORT_DISTANCE, |attachment| attachment.teleport_distance)
}

fn is_finite(pose: &Isometry3d) -> bool {
    Vec3::from(pose.translation).is_finite() && pose.rotation.is_finite()
}
