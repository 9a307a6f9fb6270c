//! Bodies get the forces of cloth.

use avian3d::prelude::{
    ComputedMass, Forces, Position, ReadRigidBodyForces, RigidBodyColliders, WriteRigidBodyForces,
};
use bevy_bunting::{AnchorReaction, AnchorReactions, Attachment, ClothReactions};
use bevy_ecs::prelude::*;
use bevy_math::Dir3;
use bevy_time::Time;
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::feels::{Carriers, FeelsCloth, target_of};
use crate::former_reaction::FormerReaction;

/// Speed at which cloth may throw a body back, of the speed at which the body came. Larger: bodies on taut cloth, whose
/// force comes a tick late, bounce ever higher. Smaller: a trampoline is none.
const RESTITUTION: f32 = 0.3;

/// Part of the speed of approach that is remembered in the next tick. Larger: a body that comes to rest on cloth trembles
/// for longer. Smaller: it is thrown back more slowly than it may be.
const REMEMBERED: f32 = 0.9;

/// Acceleration that cloth may give a body at rest by contact, m/s². Not more than gravity: cloth carries nothing. Larger:
/// bodies on taut cloth tremble.
const LIFT: f32 = 20.0;

/// Pushes bodies by the cloth that touches their colliders.
///
/// The forces of this tick are extrapolated from those of the last two. The force in one tick is limited so that the body
/// leaves cloth at most as fast as [`RESTITUTION`] and [`LIFT`] say: forces of one tick would else let a ball on a taut
/// sheet bounce ever higher.
pub(crate) fn push_by_contacts(
    mut bodies: Query<(&FeelsCloth, &RigidBodyColliders, &ComputedMass, Forces)>,
    mut colliders: Query<(&ClothReactions, &mut FormerReaction, &Position)>,
    time: Res<Time>,
) {
    let tick = time.delta_secs();
    for (feels, of_body, mass, mut body) in &mut bodies {
        let mut of_body = colliders.iter_many_mut(of_body.iter());
        while let Some((last, mut former, position)) = of_body.fetch_next() {
            let force = 2.0 * last.force - former.force;
            let torque = 2.0 * last.torque - former.torque;
            let Some((direction, strength)) = Dir3::new_and_length(force).ok() else { continue };
            let speed = body.velocity_at_point(position.0).dot(*direction);
            let approach = (REMEMBERED * former.approach).max(-speed);
            *former = FormerReaction { force: last.force, torque: last.torque, approach };
            let fastest = RESTITUTION * approach + LIFT * tick;
            let most = mass.value() * (fastest - speed).max(0.0) / tick;
            let part = (most / strength).min(1.0);
            if feels.contacts {
                body.apply_force_at_point(part * force, position.0);
                body.apply_torque(part * torque);
            }
        }
    }
}

/// Pulls bodies by the cloth that was attached to them in the last tick.
pub(crate) fn pull_by_anchors(
    cloths: Query<(Entity, &Attachment, &AnchorReactions)>,
    carriers: Carriers,
    transforms: TransformHelper,
    mut bodies: Query<Forces>,
) {
    let mut pull = |target: Entity, offset: &Transform, reaction: &AnchorReaction| {
        let Some(mut body) = carriers.of(target).and_then(|body| bodies.get_mut(body).ok()) else {
            return;
        };
        let Ok(place) = transforms.compute_global_transform(target) else { return };
        // The torque is about the place of the mesh's origin.
        body.apply_force_at_point(reaction.force, place.transform_point(offset.translation));
        body.apply_torque(reaction.torque);
    };
    for (cloth, attachment, reactions) in &cloths {
        let target = target_of(cloth, attachment);
        let offset = if target == cloth { &Transform::IDENTITY } else { &attachment.offset };
        pull(target, offset, &reactions.target);
        for (anchor, reaction) in attachment.anchors.iter().zip(&reactions.anchors) {
            pull(anchor.target, &anchor.offset, reaction);
        }
    }
}
