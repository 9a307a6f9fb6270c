//! What cloths do to colliders: forces, contact areas, and events when cloth begins and ceases to touch.

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use bunting_solver::ContactReaction;

use crate::batch::batches::ClothBatches;
use crate::batch::publish::reset_diverged;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::ClothInstance;
use crate::lod::sleep::send_to_sleep;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// What cloths do to a [`ClothCollider`](crate::ClothCollider): insert this component beside it, and read it after each
/// tick. Colliders without it cost nothing for it.
///
/// [`ClothTouched`] and [`ClothParted`] are triggered on the collider.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let ball = world.spawn((ClothCollider::ball(0.3), ClothReactions::default())).id();
/// world.add_observer(|touched: On<ClothTouched>| println!("{} touches", touched.cloth));
/// // After a tick, the force of all cloth on the ball, N.
/// let force = world.get::<ClothReactions>(ball).unwrap().force;
/// # assert_eq!(force.length(), 0.0);
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothReactions {
    /// Mean force of all cloths on the collider over the last tick, N, in the world.
    pub force: Vec3,
    /// Mean torque of all cloths about the collider's position, N·m, in the world.
    pub torque: Vec3,
    /// Area of cloth that touches the collider at the end of the tick, m².
    pub area: f32,
    /// The cloths that touch, in the order of their indices.
    by_cloth: Vec<ClothReaction>,
}

/// What one cloth does to a collider.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
pub struct ClothReaction {
    /// The cloth.
    pub cloth: Entity,
    /// Mean force on the collider over the last tick, N, in the world.
    pub force: Vec3,
    /// Mean torque about the collider's position, N·m, in the world.
    pub torque: Vec3,
    /// Area that touches the collider at the end of the tick, m².
    pub area: f32,
}

impl ClothReactions {
    /// The cloths that touch the collider, with what each of them does to it. A cloth that sleeps at rest does what it
    /// did before it fell asleep.
    #[must_use]
    pub fn by_cloth(&self) -> &[ClothReaction] {
        &self.by_cloth
    }

    /// Whether a cloth touches the collider.
    #[must_use]
    pub fn touches(&self, cloth: Entity) -> bool {
        self.by_cloth.iter().any(|reaction| reaction.cloth == cloth)
    }
}

/// A cloth has begun to touch a collider that has [`ClothReactions`].
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothTouched {
    /// The collider.
    pub entity: Entity,
    /// The cloth.
    pub cloth: Entity,
}

/// A cloth has ceased to touch a collider that has [`ClothReactions`], or was removed.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothParted {
    /// The collider.
    pub entity: Entity,
    /// The cloth.
    pub cloth: Entity,
}

/// Sums up what cloths do to colliders.
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
            let force = rotation * impulse / tick;
            let torque = rotation * angular_impulse / tick;
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
