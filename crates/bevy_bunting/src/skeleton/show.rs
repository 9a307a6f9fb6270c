//! Moves displayed surfaces to the pose of the frame that is shown.

use bevy_ecs::prelude::*;
use bevy_time::{Time, Virtual};
use bevy_transform::helper::TransformHelper;

use crate::cloth::instance::ClothInstance;
use crate::display::surface::{ClothSurface, LastTick};
use crate::motion::attachment::Attachment;
use crate::motion::frame::{frame_and_scale_of, is_finite};
use crate::motion::growth::shrink;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::particles::SkinnedParticles;

type ShownCloth = (
    Entity,
    Option<&'static Attachment>,
    &'static ClothInstance,
    &'static JointPoses,
    &'static SkinnedParticles,
    &'static mut ClothSurface,
);

/// Moves every particle by as much as its animated place has moved since the time that the surface shows: pins come to lie
/// on the shown joints exactly.
pub(super) fn show_poses(
    mut cloths: Query<ShownCloth>,
    transforms: TransformHelper,
    tick: Res<LastTick>,
    time: Res<Time<Virtual>>,
) {
    let fraction = tick.fraction(&time);
    for (entity, attachment, instance, joints, particles, mut surface) in &mut cloths {
        let frame = frame_and_scale_of(entity, attachment, &transforms);
        let frame = frame.filter(|(frame, _)| is_finite(frame));
        let (Some((frame, scale)), true) = (frame, joints.may_move()) else { continue };
        let mut pose = joints.present_matrices(frame, &transforms);
        shrink(&mut pose, instance.growth.present(scale));
        let level = surface.level;
        particles.show(level, fraction, &pose, &mut surface.positions);
    }
}
