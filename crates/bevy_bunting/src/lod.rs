//! Level of detail: how finely each cloth is simulated.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::helper::TransformHelper;

use crate::batches::ClothBatches;
use crate::error::ClothError;
use crate::instance::ClothInstance;
use crate::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};
use crate::seat::seat_cloths;
use crate::state::ClothState;

/// Default of [`LodSet::hysteresis`].
const HYSTERESIS: f32 = 0.1;

/// The levels of detail of a cloth: a dyadic chain, level 0 the mesh itself, each further one every
/// second column and row of the one before. A grid of 33 × 33 particles with three distances has
/// levels of 33, 17, 9 and 5.
///
/// The level is chosen before each tick by the distance to the nearest [`LodViewer`]. Without a
/// viewer it is the finest. By default there is one level.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct LodSet {
    /// Distance from each level to the next coarser one, m. One level more than distances.
    pub distances: Vec<f32>,
    /// Part of a distance by which it must be passed before the level changes, so that none
    /// flickers at its border.
    pub hysteresis: f32,
    /// Keeps this level whatever the distance.
    pub pinned: Option<usize>,
}

impl LodSet {
    /// Levels that switch at these distances, m.
    #[must_use]
    pub fn new(distances: impl Into<Vec<f32>>) -> Self {
        Self { distances: distances.into(), hysteresis: HYSTERESIS, pinned: None }
    }

    /// The same, kept at a level.
    #[must_use]
    pub fn pinned_to(mut self, level: usize) -> Self {
        self.pinned = Some(level);
        self
    }

    /// Number of levels.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.distances.len() + 1
    }

    /// The level at a distance in metres from the viewer, coming from level `now`.
    #[must_use]
    pub fn level_at(&self, distance: f32, now: usize) -> usize {
        if let Some(level) = self.pinned {
            return level;
        }
        let mut level = now.min(self.distances.len());
        while level < self.distances.len()
            && distance > self.distances[level] * (1.0 + self.hysteresis)
        {
            level += 1;
        }
        while level > 0 && distance < self.distances[level - 1] * (1.0 - self.hysteresis) {
            level -= 1;
        }
        level
    }

    pub(crate) fn validate(&self, entity: Entity) -> Result<(), ClothError> {
        let grow = self.distances.windows(2).all(|pair| pair[0] < pair[1]);
        let positive =
            self.distances.iter().all(|&distance| distance > 0.0 && distance.is_finite());
        if !grow || !positive || !(0.0..1.0).contains(&self.hysteresis) {
            return Err(ClothError::Distances { entity });
        }
        match self.pinned {
            Some(level) if level >= self.levels() => {
                Err(ClothError::PinnedLevel { entity, level, levels: self.levels() })
            }
            _ => Ok(()),
        }
    }
}

impl Default for LodSet {
    fn default() -> Self {
        Self::new([])
    }
}

/// Levels of detail are chosen by the distance to the nearest of these; put it on the camera.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(bevy_transform::components::Transform)]
pub struct LodViewer;

/// A cloth has changed its level of detail.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothLevelChanged {
    /// The cloth.
    pub entity: Entity,
    /// The level before; 0 is the finest.
    pub from: usize,
    /// The level from now on.
    pub to: usize,
}

/// Chooses levels of detail.
#[derive(Debug, Default)]
pub struct LodPlugin;

impl Plugin for LodPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<LodSet>().register_type::<LodViewer>().add_systems(
            ClothTick,
            select_levels.in_set(ClothSystems::SelectLod).before(seat_cloths),
        );
    }
}

fn select_levels(
    mut cloths: Query<(Entity, &LodSet, &PoseHistory, &mut ClothInstance, &mut ClothState)>,
    viewers: Query<Entity, With<LodViewer>>,
    transforms: TransformHelper,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    let viewers: Vec<Vec3> = viewers
        .iter()
        .filter_map(|viewer| Some(transforms.compute_global_transform(viewer).ok()?.translation()))
        .collect();
    for (entity, lods, frame, mut instance, mut state) in &mut cloths {
        if lods.distances.is_empty() || instance.levels.is_none() {
            continue;
        }
        // Near the middle of a grid; no pass over all particles.
        let middle = state.positions.get(state.positions.len() / 2).copied().unwrap_or_default();
        let middle = frame.end() * middle;
        let distance = viewers.iter().map(|viewer| viewer.distance(middle)).reduce(f32::min);
        let from = instance.level;
        // Without a viewer all is as near as can be.
        let to = lods.level_at(distance.unwrap_or(0.0), from);
        if to == from {
            continue;
        }
        instance.change_level(to, &mut batches);
        if let Some((fabric, snapshot)) = instance.fabric().zip(instance.waiting()) {
            state.begin(to, &Arc::clone(fabric), &snapshot.positions);
        }
        commands.trigger(ClothLevelChanged { entity, from, to });
    }
}

#[cfg(test)]
#[path = "lod_tests.rs"]
mod tests;
