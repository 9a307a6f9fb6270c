//! Sums up what cloths do to colliders.

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bunting_solver::ContactReaction;

use crate::batch::batches::ClothBatches;
use crate::batch::publish::reset_diverged;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::ClothInstance;
use crate::environment::reactions::{ClothParted, ClothReaction, ClothReactions, ClothTouched};
use crate::lod::sleep::send_to_sleep;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// Sums up what cloths do to colliders in each tick.
#[derive(Debug, Default)]
pub struct ReactionPlugin;

impl Plugin for ReactionPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothReactions>().add_systems(
            ClothTick,
            sum_reactions.in_set(ClothSystems::Publish).after(reset_diverged).before(send_to_sleep),
        );
    }
}

/// Sums up the reactions of the last tick, and triggers events.
fn sum_reactions(
    mut colliders: Query<(Entity, &mut ClothReactions)>,
    cloths: Query<(Entity, &ClothInstance, &PoseHistory)>,
    batches: Res<ClothBatches>,
    time: Res<Time>,
    mut commands: Commands,
) {
    let tick = time.delta_secs();
    if colliders.is_empty() || tick <= 0.0 {
        return;
    }
    let mut found: EntityHashMap<Vec<ClothReaction>> = EntityHashMap::default();
    for (cloth, instance, frame) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        let rotation = frame.extrapolated().1.rotation;
        for reaction in batches.reactions(lane).filter(|reaction| reaction.area > 0.0) {
            let ContactReaction { collider, impulse, angular_impulse, area } = reaction;
            let growth = &instance.growth;
            let force = rotation * (growth.force() * impulse) / tick;
            let torque = rotation * (growth.torque() * angular_impulse) / tick;
            let area = area * (growth.end() * growth.end());
            let of_collider = found.entry(Entity::from_bits(collider)).or_default();
            of_collider.push(ClothReaction { cloth, force, torque, area });
        }
    }
    for (entity, mut reactions) in &mut colliders {
        let sleeps = |cloth: Entity| {
            let instance = cloths.get(cloth).map(|(_, instance, _)| instance);
            instance.is_ok_and(|it| it.lane().is_none() && it.activity == ClothActivity::AtRest)
        };
        let before = core::mem::take(&mut reactions.by_cloth);
        let asleep = before.iter().copied().filter(|reaction| sleeps(reaction.cloth));
        let awake = found.remove(&entity).unwrap_or_default();
        let mut now: Vec<ClothReaction> = asleep.chain(awake).collect();
        now.sort_unstable_by_key(|reaction| reaction.cloth);
        reactions.force = now.iter().map(|reaction| reaction.force).sum();
        reactions.torque = now.iter().map(|reaction| reaction.torque).sum();
        reactions.area = now.iter().map(|reaction| reaction.area).sum();
        let is_in = |list: &[ClothReaction], cloth| list.iter().any(|other| other.cloth == cloth);
        for reaction in now.iter().filter(|reaction| !is_in(&before, reaction.cloth)) {
            commands.trigger(ClothTouched { entity, cloth: reaction.cloth });
        }
        for reaction in before.iter().filter(|reaction| !is_in(&now, reaction.cloth)) {
            commands.trigger(ClothParted { entity, cloth: reaction.cloth });
        }
        reactions.by_cloth = now;
    }
}
