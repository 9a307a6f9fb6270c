//! The system that moves pins in the frames of their cloths: newly attached vertices to their places, and vertices held
//! by anchors with these.

use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::motion::anchor_pins::AnchorPins;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::skeleton::particles::SkinnedParticles;

/// The anchors of a cloth.
type Anchors =
    (&'static ClothMesh, Ref<'static, Attachment>, &'static AnchorPoses, &'static mut AnchorPins);

pub(crate) fn lead_pins(
    mut cloths: Query<
        (&mut ClothInstance, &PoseHistory, Option<Anchors>),
        Without<SkinnedParticles>,
    >,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
) {
    for (mut instance, frame, mut anchors) in &mut cloths {
        // Vertices that a former attachment held on its anchors stay where they are in the frame.
        anchors.take_if(|_| instance.keeps_attachment());
        if instance.taking_up.is_none() && anchors.is_none() {
            continue;
        }
        // Written in every tick: it must not mark the cloth as changed.
        let instance = instance.bypass_change_detection();
        let (Some(lane), Some(levels)) = (instance.lane(), instance.levels.clone()) else {
            continue;
        };
        let mut lane = batches.lane(lane);
        let fabric = levels.fabric(instance.level);
        if let Some((mesh, attachment, poses, pins)) = &mut anchors {
            let positions = || lane.snapshot().positions;
            if attachment.is_changed() || !pins.fits(&levels, instance.level) {
                let groups = attachment.pinned_groups(mesh);
                pins.find(&levels, instance.level, &groups[1..], &positions());
            }
            let are_in_place = pins.find_places(fabric, poses, frame, &instance.growth);
            if !are_in_place && instance.taking_up.is_none() {
                instance.taking_up = Some(TakingUp::from_positions(fabric, &positions()));
            }
        }
        let pins = anchors.as_mut().map(|(_, _, _, pins)| &mut **pins);
        let motions = match (&mut instance.taking_up, &pins) {
            (Some(way), pins) => way.go_on(time.delta_secs(), |particle| {
                let place = pins.as_ref().and_then(|pins| pins.place(particle));
                place.unwrap_or_else(|| fabric.rest_positions()[particle as usize])
            }),
            (None, Some(pins)) => pins.motions(),
            (None, None) => Vec::new(),
        };
        instance.taking_up.take_if(|way| way.has_ended());
        if let Some(pins) = pins {
            pins.note(&motions);
        }
        lane.move_pins(motions);
    }
}
