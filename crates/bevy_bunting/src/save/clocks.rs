//! What is saved of a world besides its entities: clocks, and what is compared from tick to tick.

use bevy_ecs::prelude::*;

use crate::batch::assign::LastAssignment;
use crate::display::surface::LastTick;
use crate::environment::cloth_collision::ClothCollision;
use crate::environment::collider::ClothCollider;
use crate::environment::layers::{ClothFeatures, ClothLayers};
use crate::environment::self_collision::SelfCollision;
use crate::lod::select::LevelSelector;
use crate::lod::sleep::{Changes, SavedChanges};
use crate::motion::observation_times::ObservationTimes;
use crate::save::take::News;
use crate::settings::ClothSettings;

/// The state of a world besides its entities.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct SavedClocks {
    pub times: ObservationTimes,
    last_tick: LastTick,
    changes: SavedChanges,
    /// Number of cloths so far.
    cloths: u32,
    /// Length of the last tick, s.
    tick: f32,
    /// Whether lanes were assigned with the present settings.
    has_settings: bool,
}

impl SavedClocks {
    /// The state of a world.
    pub fn of(world: &World) -> Self {
        let settings = world.resource::<ClothSettings>();
        let last = world.resource::<LastAssignment>();
        Self {
            times: *world.resource::<ObservationTimes>(),
            last_tick: world.resource::<LastTick>().clone(),
            changes: world.resource::<Changes>().saved(settings, has_news(world)),
            cloths: world.resource::<LevelSelector>().cloths,
            tick: last.tick,
            has_settings: last.settings.as_ref() == Some(settings),
        }
    }

    /// Gives the world this state. Its clock goes on.
    pub fn restore(&self, world: &mut World) {
        let settings = world.resource::<ClothSettings>().clone();
        let mut times = world.resource_mut::<ObservationTimes>();
        let by = times.tick - self.times.tick;
        *times = self.times.on_clock_of(&times);
        *world.resource_mut::<LastTick>() = self.last_tick.clone().moved_by(by);
        world.resource_mut::<Changes>().restore(&self.changes, &settings);
        world.resource_mut::<LevelSelector>().cloths = self.cloths;
        let mut last = world.resource_mut::<LastAssignment>();
        last.tick = self.tick;
        if self.has_settings {
            last.settings = Some(settings);
        }
    }
}

/// Whether what cloth touches has changed since the last tick.
fn has_news(world: &World) -> bool {
    let Some(news) = News::of(world) else { return false };
    type Touching = Or<(
        With<ClothCollider>,
        With<ClothLayers>,
        With<ClothFeatures>,
        With<SelfCollision>,
        With<ClothCollision>,
    )>;
    let Some(mut touching) = world.try_query_filtered::<Entity, Touching>() else { return false };
    touching.iter(world).any(|entity| {
        news.has::<ClothCollider>(entity)
            || news.has::<ClothLayers>(entity)
            || news.has::<ClothFeatures>(entity)
            || news.has::<SelfCollision>(entity)
            || news.has::<ClothCollision>(entity)
    })
}
