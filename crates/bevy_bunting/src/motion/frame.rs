//! The frame that each cloth lives in: observed wherever it may be moved, and drawn where it is.

use bevy_app::prelude::*;
use bevy_app::{AnimationSystems, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::hierarchy::{ChildOf, Children};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Mat3A, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::TransformSystems;
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;
use bevy_transform::systems::{propagate_parent_transforms, sync_simple_transforms};

use crate::cloth::error::{ClothError, ClothFailed};
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::environment::drive::drive_cloths;
use crate::motion::attachment::{
    AttachedVertices, Attachment, ClothCorner, ClothEdge, TELEPORT_SPEED, TargetLost,
};
use crate::motion::follow::{Motions, end_following, follow_targets};
use crate::motion::pose::{Observed, PoseHistory};
use crate::motion::take_up::lead_pins;
use crate::schedule::{ClothSystems, ClothTick};

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
            .init_resource::<Observed>()
            .add_observer(end_following)
            .add_systems(
                RunFixedMainLoop,
                observe_frames::<true>.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                ClothTick,
                (
                    follow_targets.in_set(ClothSystems::Prepare),
                    observe_ticks.in_set(ClothSystems::Drive).before(drive_cloths),
                    lead_pins.in_set(ClothSystems::Drive).before(drive_cloths).after(observe_ticks),
                    place_cloths.in_set(ClothSystems::Publish),
                ),
            )
            .add_systems(
                PostUpdate,
                (follow_targets, observe_frames::<false>, place_cloths)
                    .chain_ignore_deferred()
                    .after(AnimationSystems)
                    .before(TransformSystems::Propagate),
            )
            .add_systems(
                PostUpdate,
                unscale_cloths
                    .in_set(TransformSystems::Propagate)
                    .after(propagate_parent_transforms)
                    .after(sync_simple_transforms),
            );
    }
}

type Disturbed<'w, 's> = Query<'w, 's, Entity, Changed<PoseHistory>>;

type Observable = (&'static mut PoseHistory, Option<&'static Attachment>);

/// What was moved, and who is observed because of that, or because it was moved of late.
#[derive(SystemParam)]
struct Watch<'w, 's> {
    motions: Motions<'w, 's>,
    /// Who is new, begins anew, or will jump; and all.
    histories: ParamSet<'w, 's, (Disturbed<'static, 'static>, Query<'static, 'static, Observable>)>,
    /// Who did not rest yet when the system last ran.
    restless: Local<'s, Vec<Entity>>,
}

impl Watch<'_, '_> {
    /// Does the same with everyone that may have moved.
    fn for_each(&mut self, mut observe: impl FnMut(Entity, &mut PoseHistory, Option<&Attachment>)) {
        let disturbed = self.histories.p0();
        let moved = self.motions.find(self.restless.drain(..).chain(&disturbed));
        let mut histories = self.histories.p1();
        for &entity in moved {
            let Ok((mut history, attachment)) = histories.get_mut(entity) else { continue };
            // What is seen here is no change, as everyone sees it; but not all may have seen a rest end.
            let rested = history.rests();
            observe(entity, history.bypass_change_detection(), attachment);
            if !history.rests() {
                self.restless.push(entity);
                if rested {
                    history.set_changed();
                }
            }
        }
    }
}

/// Notes where everything is in a frame; `EARLY`, before its ticks.
fn observe_frames<const EARLY: bool>(
    mut watch: Watch,
    transforms: TransformHelper,
    time: Res<Time<Virtual>>,
    mut observed: ResMut<Observed>,
) {
    let now = time.elapsed_secs_f64();
    if EARLY {
        observed.note_frame(time.delta_secs_f64());
    }
    watch.for_each(|entity, history, attachment| {
        if let Some(pose) = frame_of(entity, attachment, &transforms).filter(is_finite) {
            history.observe_frame(&observed, now, pose, teleport_speed(attachment), EARLY);
        }
    });
    if !EARLY {
        observed.frame = now;
    }
}

/// Notes where everything is in a tick, and so how it moves in it.
fn observe_ticks(
    mut watch: Watch,
    mut instances: Query<&mut ClothInstance>,
    transforms: TransformHelper,
    time: Res<Time>,
    mut observed: ResMut<Observed>,
    mut commands: Commands,
) {
    let now = Observed {
        tick: time.elapsed_secs_f64(),
        ticks: observed.ticks.wrapping_add(1),
        ..*observed
    };
    let tick = time.delta_secs_f64();
    watch.for_each(|entity, history, attachment| {
        let pose = frame_of(entity, attachment, &transforms);
        match pose.filter(is_finite) {
            Some(pose) => {
                history.observe_tick(&observed, &now, tick, pose, teleport_speed(attachment));
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
    });
    *observed = now;
}

type Placed = (Option<&'static Attachment>, Option<&'static ChildOf>);

type Written<'w, 's> = Query<'w, 's, (&'static mut Transform, &'static mut GlobalTransform)>;

/// Writes the transforms of attached cloths: where their targets are now, whatever the last tick
/// saw.
fn place_cloths(
    cloths: Query<Placed, With<ClothMesh>>,
    new: Query<Entity, Added<ClothMesh>>,
    mut transforms: ParamSet<((TransformHelper, Motions), Written)>,
    mut placed: Local<Vec<(Entity, Option<Transform>, GlobalTransform)>>,
) {
    let (current, mut motions) = transforms.p0();
    placed.clear();
    placed.extend(motions.find(new).iter().filter_map(|&entity| {
        let (attachment, parent) = cloths.get(entity).ok()?;
        let parent = parent.map(ChildOf::parent);
        match attachment
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
            None => {
                let frame =
                    frame_on(&current.compute_global_transform(entity).ok()?, &Transform::IDENTITY);
                Some((entity, None, GlobalTransform::from_isometry(frame)))
            }
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

/// How far the axes of a frame may be from unit vectors at right angles before the scale is taken out.
const RIGID: f32 = 1e-4;

type Hierarchy<'w, 's> =
    Query<'w, 's, (&'static Transform, Option<&'static Children>, &'static mut GlobalTransform)>;

type Propagated<'w, 's> = Query<
    'w,
    's,
    (Entity, Option<&'static Attachment>, &'static GlobalTransform),
    (With<ClothMesh>, Changed<GlobalTransform>),
>;

/// Takes the scale of parents, targets and of the cloth's own [`Transform`] out of what Bevy has propagated: a
/// frame has none, and a local transform cannot undo a scale along turned axes.
fn unscale_cloths(
    mut transforms: ParamSet<((TransformHelper, Propagated), Hierarchy)>,
    mut found: Local<Vec<(Entity, GlobalTransform)>>,
) {
    let (helper, cloths) = transforms.p0();
    found.extend(cloths.iter().filter_map(|(entity, attachment, propagated)| {
        let axes = propagated.affine().matrix3;
        let product = axes.transpose() * axes;
        if product.abs_diff_eq(Mat3A::IDENTITY, RIGID) {
            return None;
        }
        let frame = frame_of(entity, attachment, &helper).filter(is_finite)?;
        Some((entity, GlobalTransform::from_isometry(frame)))
    }));
    let mut hierarchy = transforms.p1();
    // Each with its children, whose places have changed with it.
    while let Some((entity, global)) = found.pop() {
        let Ok((_, children, mut written)) = hierarchy.get_mut(entity) else { continue };
        *written = global;
        let children: Vec<Entity> = children.into_iter().flat_map(|all| all.iter()).collect();
        for child in children {
            if let Ok((local, ..)) = hierarchy.get(child) {
                found.push((child, global * *local));
            }
        }
    }
}

/// The pose of a cloth's frame, or a collider's, as its entity or target stands now. None if the
/// target is gone.
pub(crate) fn frame_of(
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

fn teleport_speed(attachment: Option<&Attachment>) -> f32 {
    attachment.map_or(TELEPORT_SPEED, |attachment| attachment.teleport_speed)
}

pub(crate) fn is_finite(pose: &Isometry3d) -> bool {
    Vec3::from(pose.translation).is_finite() && pose.rotation.is_finite()
}
