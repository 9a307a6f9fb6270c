//! What is saved of all cloths of a world.

use bevy_ecs::entity::{EntityMapper, MapEntities};
use bevy_ecs::prelude::*;

use crate::cloth::instance::ClothInstance;
use crate::environment::collider_tree::ColliderTree;
use crate::save::apply::apply;
use crate::save::check::{Fitting, check};
use crate::save::clocks::SavedClocks;
use crate::save::cloth::SavedCloth;
use crate::save::error::SnapshotError;
use crate::save::lanes::{enter_lanes, mark};
use crate::save::others::{ColliderOrder, SavedOther};
use crate::save::take::take;

/// The state of all cloth of a world between two ticks: that of each cloth as in a [`ClothSnapshot`](crate::ClothSnapshot);
/// what is known of the motion of colliders, winds and hands; the phases of gusts, trails and blasts; and clocks.
///
/// It is taken and restored by [`ClothSaves`](crate::ClothSaves). Where it is restored in another app, or after entities
/// were spawned anew, [`MapEntities`] puts the entities of now in the places of those that were saved. One that has no
/// counterpart is mapped to [`Entity::PLACEHOLDER`], and left out.
///
/// With the feature `serialize` it is written as bytes (`to_bytes`), which hold a version and a checksum, and implements
/// serde's traits by these bytes.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<u8>", into = "Vec<u8>")
)]
pub struct ClothWorldSnapshot(pub(super) SavedWorld);

/// The state of all cloth of a world.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct SavedWorld {
    clocks: SavedClocks,
    cloths: Vec<KeptCloth>,
    others: Vec<SavedOther>,
    colliders: ColliderOrder,
}

/// A cloth of a saved world.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct KeptCloth {
    #[cfg_attr(feature = "serialize", serde(with = "crate::save::entity_bits"))]
    entity: Entity,
    saved: SavedCloth,
}

impl ClothWorldSnapshot {
    /// The cloths.
    pub fn cloths(&self) -> impl Iterator<Item = Entity> + '_ {
        self.0.cloths.iter().map(|cloth| cloth.entity)
    }

    /// All entities that the snapshot is about: the cloths, colliders, winds, and hands that grab.
    pub fn entities(&self) -> impl Iterator<Item = Entity> + '_ {
        self.cloths().chain(self.0.others.iter().map(|other| other.entity))
    }

    /// The state of a world.
    ///
    /// # Errors
    ///
    /// A cloth has a state that its components will replace in the next tick.
    pub(super) fn of(world: &World) -> Result<Self, SnapshotError> {
        let mut cloths = Vec::new();
        let mut query = world.try_query_filtered::<Entity, With<ClothInstance>>();
        for entity in query.iter_mut().flat_map(|query| query.iter(world)) {
            match take(world, entity) {
                Ok(saved) => cloths.push(KeptCloth { entity, saved }),
                // Those that have no state yet begin anew.
                Err(SnapshotError::NotSimulated { .. } | SnapshotError::NotACloth { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Self(SavedWorld {
            clocks: SavedClocks::of(world),
            cloths,
            others: SavedOther::all(world),
            colliders: ColliderOrder::of(world.resource::<ColliderTree>()),
        }))
    }

    /// Gives a world this state.
    ///
    /// # Errors
    ///
    /// A cloth is not there, or does not fit its snapshot. The world is then unchanged.
    pub(super) fn restore(&self, world: &mut World) -> Result<(), SnapshotError> {
        let SavedWorld { clocks, cloths, others, colliders } = &self.0;
        let cloths = cloths.iter().filter(|cloth| cloth.entity != Entity::PLACEHOLDER);
        let cloths: Vec<(Fitting, &SavedCloth)> = cloths
            .map(|KeptCloth { entity, saved }| Ok((check(world, *entity, saved)?, saved)))
            .collect::<Result<_, SnapshotError>>()?;
        let now = *world.resource();
        for (fitting, saved) in &cloths {
            apply(world, fitting, saved);
        }
        enter_lanes(world, cloths.iter().map(|(fitting, saved)| (fitting.entity, *saved)));
        for other in others {
            other.restore(world, &clocks.times, &now);
        }
        clocks.restore(world);
        colliders.restore(world);
        let restored = cloths.iter().map(|(fitting, _)| fitting.entity);
        mark(world, restored.chain(others.iter().map(|other| other.entity)));
        Ok(())
    }
}

impl MapEntities for ClothWorldSnapshot {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        for cloth in &mut self.0.cloths {
            cloth.entity = mapper.get_mapped(cloth.entity);
        }
        self.0.others.iter_mut().for_each(|other| other.map(mapper));
        self.0.colliders.map(mapper);
    }
}
