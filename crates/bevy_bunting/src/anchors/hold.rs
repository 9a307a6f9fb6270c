//! The system that holds cloths by springs and rails.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bunting_solver::{Hold, Holder};

use crate::anchors::grab::{ClothGrab, Grabbed};
use crate::anchors::holds::{ClothHolds, Owner};
use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::lod::rest_timer::RestTimer;
use crate::motion::anchor_hold::AnchorHold;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;
use crate::motion::growth::Growth;
use crate::motion::pose::PoseHistory;

/// Start and end of a tick.
type Span = (Isometry3d, Isometry3d);

/// The frame of a cloth in a tick, and how large the cloth is.
#[derive(Clone, Copy)]
struct Frame {
    span: Span,
    growth: Growth,
}

/// A cloth that is held.
type HeldCloth = (
    Entity,
    &'static ClothInstance,
    &'static ClothMesh,
    Option<Ref<'static, Attachment>>,
    &'static PoseHistory,
    Option<&'static AnchorPoses>,
    &'static mut ClothHolds,
    &'static mut RestTimer,
);

/// An entity that grabs a cloth.
type Hand = (Entity, &'static ClothGrab, &'static mut Grabbed, &'static PoseHistory);

/// Gives the solver all holds of this tick.
pub(crate) fn hold_cloths(
    mut cloths: Query<HeldCloth>,
    mut hands: Query<Hand, Without<ClothHolds>>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    if cloths.is_empty() {
        return;
    }
    let mut grabs: Vec<(Entity, Entity)> =
        hands.iter().map(|(hand, grab, ..)| (grab.cloth, hand)).collect();
    grabs.sort_unstable();
    for (entity, instance, mesh, attachment, frame, poses, mut holds, mut timer) in &mut cloths {
        let (Some(lane), Some(levels)) = (instance.lane(), &instance.levels) else { continue };
        let growth = instance.growth;
        let frame = Frame { span: (frame.start(), frame.end()), growth };
        let size = growth.end();
        let is_changed = attachment.as_ref().is_some_and(|attachment| attachment.is_changed());
        if is_changed || !holds.fits(levels, instance.level) {
            let (groups, rails) = attachment
                .as_ref()
                .map(|attachment| (attachment.sprung_groups(mesh), attachment.rails()))
                .unwrap_or_default();
            holds.find(levels, instance.level, &groups, rails);
        }
        let mut list = Vec::new();
        holds.owners.clear();
        let ClothHolds { anchored, counts, rails, owners, .. } = &mut *holds;
        for &(index, particle, place) in anchored.iter() {
            let anchor = attachment.as_ref().and_then(|attachment| attachment.anchors.get(index));
            let pose = poses.and_then(|poses| poses.span(index));
            let (Some(anchor), Some(pose)) = (anchor, pose) else { continue };
            let share = 1.0 / counts[index] as f32;
            let by = match (&anchor.hold, &rails[index]) {
                (AnchorHold::Spring { stiffness, max_force }, _) => Holder::Spring {
                    place: frame
                        .place([pose.0 * (growth.start() * place), pose.1 * (size * place)]),
                    stiffness: share * stiffness / (size * size),
                    max_force: share * max_force / growth.force(),
                },
                (AnchorHold::Rail { ring_mass, friction, .. }, Some(rail)) => Holder::Ring {
                    rail: rail.clone(),
                    pose: frame.poses(pose),
                    mass: *ring_mass / (size * size),
                    friction: *friction,
                },
                _ => continue,
            };
            list.push(Hold { particle, by });
            owners.push(Owner::Anchor { index, particle });
        }
        let first = grabs.partition_point(|&(cloth, _)| cloth < entity);
        let of_cloth = grabs[first..].iter().take_while(|&&(cloth, _)| cloth == entity);
        for &(_, hand) in of_cloth {
            let Ok((_, grab, mut grabbed, pose)) = hands.get_mut(hand) else { continue };
            if !grab.is_valid() || !pose.is_observed() {
                continue;
            }
            timer.restart();
            let pose = (pose.start(), pose.end());
            let is_new = grabbed.is_new();
            if is_new || !grabbed.fits(levels, instance.level) {
                let to_hand = pose.0.inverse() * frame.span.0;
                let positions = batches.lane(lane).snapshot().positions;
                let places: Vec<Vec3> =
                    positions.into_iter().map(|at| to_hand * (growth.start() * at)).collect();
                if is_new {
                    grabbed.grab(grab, levels, instance.level, &places);
                } else {
                    grabbed.change_level(levels, instance.level, &places);
                }
            }
            let share = 1.0 / grabbed.held.len().max(1) as f32;
            for &(particle, place) in &grabbed.held {
                let by = Holder::Spring {
                    place: frame.place([pose.0 * place, pose.1 * place]),
                    stiffness: share * grab.stiffness / (size * size),
                    max_force: share * grab.max_force / growth.force(),
                };
                list.push(Hold { particle, by });
                owners.push(Owner::Grab(hand));
            }
        }
        let is_idle = anchored.is_empty() && grabs.iter().all(|&(cloth, _)| cloth != entity);
        batches.lane(lane).hold(list);
        if is_idle {
            commands.entity(entity).remove::<ClothHolds>();
        }
    }
}

impl Frame {
    /// A place in the world at the start and at the end of the tick, m, in the frame at that time.
    fn place(&self, [start, end]: [Vec3; 2]) -> [Vec3; 2] {
        self.growth.places([self.span.0.inverse() * start, self.span.1.inverse() * end])
    }

    /// A moving pose in the frame at the start and at the end of the tick.
    fn poses(&self, pose: Span) -> [(Vec3, Quat); 2] {
        let poses = [self.span.0.inverse() * pose.0, self.span.1.inverse() * pose.1];
        let [start, end] = self.growth.places(poses.map(|pose| pose.translation.into()));
        [(start, poses[0].rotation), (end, poses[1].rotation)]
    }
}
