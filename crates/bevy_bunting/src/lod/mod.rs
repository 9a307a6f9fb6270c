//! Level of detail: how finely each cloth is simulated.

mod budget;
mod choose;
mod costs;
mod error;
mod governor;
mod kinds;
pub mod sleep;
mod viewer;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::batch::assign::seat_cloths;
use crate::cloth::error::ClothError;
use crate::diagnostics::ClothCounts;
use crate::schedule::{ClothSystems, ClothTick};

pub use budget::{ClothBudget, LodCosts, LodReport};
pub(crate) use choose::choose_levels;
pub use costs::CostTable;
pub(crate) use costs::Measured;
pub(crate) use governor::Candidate;
pub use viewer::{Lens, LodViewer};

/// Default of [`LodSet::hysteresis`].
const HYSTERESIS: f32 = 0.1;

/// The levels of detail of a cloth: level 0 is the mesh itself, and each further one has some of the
/// vertices of the one before: of a grid every second column and row, of any other mesh what
/// [`FabricBuilder::coarser`](bunting_solver::FabricBuilder::coarser) leaves. A grid of 33 × 33
/// particles with four levels has 33, 17, 9 and 5. By default there is one level.
///
/// The level is chosen before each tick by what the [`LodViewer`]s see. Without a viewer everything
/// is as near as can be.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct LodSet {
    /// How many levels there are, and how one is chosen.
    pub choice: LodChoice,
    /// Part of a switch distance by which it must be passed before the level changes, so that none
    /// flickers at its border. Of no use to an automatic choice.
    pub hysteresis: f32,
    /// Keeps this level whatever is seen.
    pub pinned: Option<usize>,
    /// How many times as large as it is the cloth counts in an automatic choice: above 1 for what the
    /// player looks at, below for what no one minds.
    pub bias: f32,
}

/// How the level of a cloth is chosen.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Debug, PartialEq, Clone)]
pub enum LodChoice {
    /// By the distance to the nearest viewer, whatever it costs. Distances from each level to the
    /// next coarser one, m; one level more than distances.
    Distances(Vec<f32>),
    /// By the error in pixels, within the [`ClothBudget`]. Out of everybody's picture the cloth is
    /// asleep.
    Automatic {
        /// Number of levels, at least 1.
        levels: usize,
    },
}

impl LodSet {
    /// Levels that switch at these distances, m.
    #[must_use]
    pub fn new(distances: impl Into<Vec<f32>>) -> Self {
        Self::chosen(LodChoice::Distances(distances.into()))
    }

    /// So many levels, chosen by the error in pixels that each has in the viewers' pictures, as far
    /// as the [`ClothBudget`] goes.
    #[must_use]
    pub fn automatic(levels: usize) -> Self {
        Self::chosen(LodChoice::Automatic { levels })
    }

    fn chosen(choice: LodChoice) -> Self {
        Self { choice, hysteresis: HYSTERESIS, pinned: None, bias: 1.0 }
    }

    /// The same, kept at a level.
    #[must_use]
    pub fn pinned_to(mut self, level: usize) -> Self {
        self.pinned = Some(level);
        self
    }

    /// The same, with the cloth counting as so many times as large as it is.
    #[must_use]
    pub fn with_bias(mut self, bias: f32) -> Self {
        self.bias = bias;
        self
    }

    /// Number of levels.
    #[must_use]
    pub fn levels(&self) -> usize {
        match &self.choice {
            LodChoice::Distances(distances) => distances.len() + 1,
            LodChoice::Automatic { levels } => *levels,
        }
    }

    /// The level at a distance in metres from the viewer, coming from level `now`; where the choice
    /// is automatic, `now`.
    #[must_use]
    pub fn level_at(&self, distance: f32, now: usize) -> usize {
        if let Some(level) = self.pinned {
            return level;
        }
        let LodChoice::Distances(distances) = &self.choice else { return now };
        let mut level = now.min(distances.len());
        while level < distances.len() && distance > distances[level] * (1.0 + self.hysteresis) {
            level += 1;
        }
        while level > 0 && distance < distances[level - 1] * (1.0 - self.hysteresis) {
            level -= 1;
        }
        level
    }

    pub(crate) fn validate(&self, entity: Entity) -> Result<(), ClothError> {
        let good = match &self.choice {
            LodChoice::Distances(distances) => {
                let grow = distances.windows(2).all(|pair| pair[0] < pair[1]);
                grow && distances.iter().all(|&distance| distance > 0.0 && distance.is_finite())
            }
            LodChoice::Automatic { levels } => *levels > 0,
        };
        let biased = self.bias > 0.0 && self.bias.is_finite();
        if !good || !biased || !(0.0..1.0).contains(&self.hysteresis) {
            return Err(ClothError::Levels { entity });
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
        app.register_type::<LodSet>()
            .register_type::<LodViewer>()
            .register_type::<ClothBudget>()
            .register_type::<LodReport>()
            .init_resource::<ClothBudget>()
            .init_resource::<LodReport>()
            .init_resource::<ClothCounts>()
            .init_resource::<choose::Chooser>()
            .add_systems(
                ClothTick,
                choose_levels.in_set(ClothSystems::SelectLod).before(seat_cloths),
            );
    }
}

#[cfg(test)]
mod tests;
