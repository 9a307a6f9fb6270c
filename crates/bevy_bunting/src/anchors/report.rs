//! The systems that ask for reactions of anchors, and publish them.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::Time;

use crate::anchors::grab::Grabbed;
use crate::anchors::holds::{ClothHolds, Owner};
use crate::anchors::reactions::{AnchorReaction, AnchorReactions, PinReporting};
use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::state::ClothState;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;
use crate::motion::pose::PoseHistory;

type ReportingCloth = (
    &'static ClothInstance,
    &'static ClothMesh,
    Option<Ref<'static, Attachment>>,
    &'static PoseHistory,
    Option<&'static AnchorPoses>,
    &'static mut PinReporting,
);

/// Asks for the reactions of this tick.
pub(super) fn ask_for_reactions(
    mut cloths: Query<ReportingCloth, With<AnchorReactions>>,
    mut batches: ResMut<ClothBatches>,
) {
    for (instance, mesh, attachment, frame, poses, mut reporting) in &mut cloths {
        let (Some(lane), Some(levels)) = (instance.lane(), &instance.levels) else { continue };
        let is_changed = attachment.as_ref().is_some_and(|attachment| attachment.is_changed());
        if is_changed || !reporting.fits(levels, instance.level) {
            let held = attachment.as_ref().map(|attachment| attachment.pinned_groups(mesh));
            reporting.find(levels, instance.level, &held.unwrap_or_default());
        }
        let anchors = attachment.map_or(0, |attachment| attachment.anchors.len());
        let pivots = (0..anchors).map(|anchor| pivot(frame, poses, anchor));
        let pivots = pivots.map(|places| instance.growth.places(places));
        let pivots = core::iter::once([Vec3::ZERO; 2]).chain(pivots).collect();
        if let Some(groups) = &reporting.groups {
            batches.lane(lane).report_pins(Some((groups, pivots)));
        }
    }
}

/// Place of an anchor's origin at the start and at the end of the tick, each in the cloth's frame at that time, m.
fn pivot(frame: &PoseHistory, poses: Option<&AnchorPoses>, anchor: usize) -> [Vec3; 2] {
    let Some((from, to)) = poses.and_then(|poses| poses.span(anchor)) else {
        return [Vec3::ZERO; 2];
    };
    let place =
        |frame: Isometry3d, pose: Isometry3d| frame.inverse() * Vec3::from(pose.translation);
    [place(frame.start(), from), place(frame.end(), to)]
}

/// A cloth that is held, and its reactions.
type HeldCloth = (
    &'static ClothInstance,
    &'static ClothState,
    &'static PoseHistory,
    Option<&'static mut AnchorReactions>,
    Option<&'static ClothHolds>,
    Option<&'static AnchorPoses>,
);

/// Filter of cloths that are held or report.
type HoldsOrReports = Or<(With<AnchorReactions>, With<ClothHolds>)>;

/// Writes the reactions of the last tick. A cloth that has no lane keeps its own.
pub(super) fn publish_reactions(
    mut cloths: Query<HeldCloth, HoldsOrReports>,
    mut hands: Query<&mut Grabbed>,
    batches: Res<ClothBatches>,
    time: Res<Time>,
) {
    let tick = time.delta_secs();
    hands.iter_mut().for_each(|mut hand| hand.force = Vec3::ZERO);
    for (instance, state, frame, mut reactions, holds, poses) in &mut cloths {
        let Some(lane) = instance.lane() else { continue };
        let (frame, growth) = (frame.end(), &instance.growth);
        if let Some(reactions) = &mut reactions {
            let mut means = batches.pin_reactions(lane).iter().map(|reaction| AnchorReaction {
                force: frame.rotation * (growth.force() * reaction.impulse) / tick,
                torque: frame.rotation * (growth.torque() * reaction.angular_impulse) / tick,
            });
            reactions.target = means.next().unwrap_or_default();
            reactions.anchors.clear();
            reactions.anchors.extend(means);
        }
        let owners = holds.iter().flat_map(|holds| &holds.owners);
        for (owner, &impulse) in owners.zip(batches.hold_impulses(lane)) {
            let force = frame.rotation * (growth.force() * impulse) / tick;
            match *owner {
                Owner::Grab(hand) => {
                    if let Ok(mut hand) = hands.get_mut(hand) {
                        hand.force += force;
                    }
                }
                Owner::Anchor { index, particle } => {
                    let Some((_, pose)) = poses.and_then(|poses| poses.span(index)) else {
                        continue;
                    };
                    let anchors = reactions.iter_mut().map(|reactions| &mut reactions.anchors);
                    for anchor in anchors.flat_map(|anchors| anchors.get_mut(index)) {
                        let at = frame * (growth.end() * state.positions()[particle as usize]);
                        anchor.force += force;
                        anchor.torque += (at - Vec3::from(pose.translation)).cross(force);
                    }
                }
            }
        }
    }
}

/// Ceases to report the reactions of a cloth that loses its [`AnchorReactions`].
pub(super) fn stop_reporting(
    removed: On<Remove, AnchorReactions>,
    cloths: Query<&ClothInstance>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    let lane = cloths.get(removed.entity).ok().and_then(ClothInstance::lane);
    if let Some(lane) = lane {
        batches.lane(lane).report_pins(None);
    }
    commands.entity(removed.entity).try_remove::<PinReporting>();
}
