//! What is saved of entities that are no cloth: those that move air, that cloth touches, and that hold it.

use bevy_ecs::entity::EntityMapper;
use bevy_ecs::prelude::*;

use crate::anchors::grab::{ClothGrab, Grabbed};
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::environment::collider::ClothCollider;
use crate::environment::collider_tree::ColliderTree;
use crate::environment::reactions::ClothReactions;
use crate::environment::wind::blast::WindBlast;
use crate::environment::wind::field::GustTravel;
use crate::environment::wind::wake::WakeTrail;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;

/// The state of an entity that is no cloth.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct SavedOther {
    #[cfg_attr(feature = "serialize", serde(with = "crate::save::entity_bits"))]
    pub entity: Entity,
    history: Option<PoseHistory>,
    travel: Option<GustTravel>,
    trail: Option<WakeTrail>,
    blast: Option<WindBlast>,
    reactions: Option<ClothReactions>,
    grabbed: Option<Grabbed>,
}

type Other = (
    Entity,
    Option<&'static PoseHistory>,
    Option<&'static GustTravel>,
    Option<&'static WakeTrail>,
    Option<&'static WindBlast>,
    Option<&'static ClothReactions>,
    Option<&'static Grabbed>,
);

type IsOther =
    (Without<ClothMesh>, Or<(With<PoseHistory>, With<GustTravel>, With<ClothReactions>)>);

impl SavedOther {
    /// The state of all entities that have one.
    pub fn all(world: &World) -> Vec<Self> {
        let Some(mut others) = world.try_query_filtered::<Other, IsOther>() else {
            return Vec::new();
        };
        let others = others.iter(world);
        let saved =
            others.map(|(entity, history, travel, trail, blast, reactions, grabbed)| Self {
                entity,
                history: history.cloned(),
                travel: travel.copied(),
                trail: trail.cloned(),
                blast: blast.copied(),
                reactions: reactions.cloned(),
                grabbed: grabbed.cloned(),
            });
        saved.collect()
    }

    /// Maps all entities.
    pub fn map(&mut self, mapper: &mut impl EntityMapper) {
        self.entity = mapper.get_mapped(self.entity);
        for reaction in self.reactions.iter_mut().flat_map(|reactions| &mut reactions.by_cloth) {
            reaction.cloth = mapper.get_mapped(reaction.cloth);
        }
    }

    /// Gives the entity its state, if it is there.
    pub fn restore(&self, world: &mut World, from: &ObservationTimes, to: &ObservationTimes) {
        let Ok(mut entity) = world.get_entity_mut(self.entity) else { return };
        if let (Some(mut known), Some(history)) = (entity.get_mut::<PoseHistory>(), &self.history) {
            *known = history.clone();
            known.move_times(from, to);
        }
        if let (Some(mut known), Some(travel)) = (entity.get_mut::<GustTravel>(), self.travel) {
            *known = travel;
        }
        if let (Some(mut known), Some(trail)) = (entity.get_mut::<WakeTrail>(), &self.trail) {
            known.clone_from(trail);
        }
        match self.blast {
            // A blast that is over has no component.
            Some(blast) => _ = entity.insert(blast),
            None => _ = entity.remove::<WindBlast>(),
        }
        if let Some(mut known) = entity.get_mut::<ClothReactions>() {
            // Those that were asked for later knew of nothing then.
            *known = self.reactions.clone().unwrap_or_default();
        }
        self.restore_grab(world);
    }

    fn restore_grab(&self, world: &mut World) {
        let Some(grabbed) = &self.grabbed else { return };
        let cloth = world.get::<ClothGrab>(self.entity).map(|grab| grab.cloth);
        let instance = cloth.and_then(|cloth| world.get::<ClothInstance>(cloth));
        let restored = instance.and_then(|instance| {
            let levels = instance.levels.as_ref()?;
            Some(grabbed.clone().restored(levels, instance.level))
        });
        if let (Some(mut known), Some(restored)) = (world.get_mut::<Grabbed>(self.entity), restored)
        {
            *known = restored;
        }
    }
}

/// The order in which cloth meets colliders, which follows from the order in which they came and went.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct ColliderOrder {
    colliders: Vec<Option<Collider>>,
    free: Vec<u32>,
}

/// A collider in its place.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct Collider {
    #[cfg_attr(feature = "serialize", serde(with = "crate::save::entity_bits"))]
    entity: Entity,
}

impl ColliderOrder {
    pub fn of(tree: &ColliderTree) -> Self {
        let (order, free) = tree.order();
        let collider = |entity: &Option<Entity>| entity.map(|entity| Collider { entity });
        Self { colliders: order.iter().map(collider).collect(), free: free.to_vec() }
    }

    /// Maps all entities.
    pub fn map(&mut self, mapper: &mut impl EntityMapper) {
        for collider in self.colliders.iter_mut().flatten() {
            collider.entity = mapper.get_mapped(collider.entity);
        }
    }

    /// Puts the colliders that are there in this order.
    pub fn restore(&self, world: &mut World) {
        let is_there = |it: &Collider| world.get::<ClothCollider>(it.entity).is_some();
        let order = self.colliders.iter().map(|it| it.filter(is_there).map(|it| it.entity));
        let order: Vec<Option<Entity>> = order.collect();
        world.resource_mut::<ColliderTree>().restore(&order, &self.free);
    }
}
