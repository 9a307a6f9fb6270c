//! The levels of detail of a cloth, and the rule by which its level is chosen.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::error::ClothError;

/// Default of [`LodSet::hysteresis`]. Smaller: a viewer that sways at a switch distance causes repeated
/// changes of level.
const HYSTERESIS: f32 = 0.1;

/// The levels of detail of a cloth, and how its level is chosen. Level 0 is the mesh itself. Each further
/// level keeps some of the vertices of the one before: every second column and row of a grid; of any other
/// mesh those that [`FabricBuilder::coarser`](bunting_solver::FabricBuilder::coarser) keeps. A grid of 33 ×
/// 33 particles with four levels has 33, 17, 9 and 5 particles in a row. By default there is one level.
///
/// The level is chosen before each tick from the positions and lenses of the
/// [`LodViewer`](crate::LodViewer)s. Without a viewer every cloth counts as being at distance 0 and on the
/// screen.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Three levels that switch at 10 m and 30 m; and four that are chosen within the budget.
/// let by_distance = (ClothMesh::grid(33, 33, 1.0, 1.0), LodSet::new([10.0, 30.0]));
/// let automatic = (ClothMesh::grid(33, 33, 1.0, 1.0), LodSet::automatic(4));
/// assert_eq!((by_distance.1.levels(), automatic.1.levels()), (3, 4));
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct LodSet {
    /// Number of levels, and the rule by which one is chosen.
    pub choice: LodChoice,
    /// Fraction of a switch distance by which the distance must pass it before the level changes, from 0 to
    /// 1. An automatic choice ignores it.
    pub hysteresis: f32,
    /// Level at which the cloth is kept, whatever the viewers see.
    pub pinned: Option<usize>,
    /// Factor on the size of the cloth on the screen in an automatic choice: above 1 for cloth that matters
    /// to the player, below 1 for cloth in the background. Positive.
    pub bias: f32,
}

/// Rule by which the level of a cloth is chosen.
///
/// ```
/// use bevy_bunting::LodChoice;
/// use bevy_bunting::prelude::*;
///
/// // The next level from 10 m on, and the third from 30 m on.
/// let choice = LodChoice::Distances(vec![10.0, 30.0]);
/// assert_eq!(LodSet { choice, ..LodSet::default() }, LodSet::new([10.0, 30.0]));
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum LodChoice {
    /// The level follows the distance to the nearest viewer, regardless of cost. Each level switches to the
    /// next coarser one at one of the distances (m, ascending); there is one level more than distances.
    Distances(Vec<f32>),
    /// The level follows the error in pixels, within the [`ClothBudget`](crate::ClothBudget). Outside the
    /// picture of every viewer the cloth sleeps.
    Automatic {
        /// Number of levels, at least 1.
        levels: usize,
    },
}

impl LodSet {
    /// Levels that switch at the given distances, m.
    #[must_use]
    pub fn new(distances: impl Into<Vec<f32>>) -> Self {
        Self::chosen(LodChoice::Distances(distances.into()))
    }

    /// The given number of levels, chosen by their errors in pixels in the viewers' pictures, within the
    /// [`ClothBudget`](crate::ClothBudget).
    #[must_use]
    pub fn automatic(levels: usize) -> Self {
        Self::chosen(LodChoice::Automatic { levels })
    }

    fn chosen(choice: LodChoice) -> Self {
        Self { choice, hysteresis: HYSTERESIS, pinned: None, bias: 1.0 }
    }

    /// The levels, with the cloth kept at one of them.
    #[must_use]
    pub fn pinned_to(mut self, level: usize) -> Self {
        self.pinned = Some(level);
        self
    }

    /// The levels with a [`bias`](Self::bias).
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

    /// The level at a distance (m) from the nearest viewer, for a cloth that is at level `now`. With an
    /// automatic choice, `now`.
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

    /// Checks distances, number of levels, hysteresis, bias and pinned level of the cloth `entity`.
    pub(crate) fn validate(&self, entity: Entity) -> Result<(), ClothError> {
        let good = match &self.choice {
            LodChoice::Distances(distances) => {
                let grow = distances.windows(2).all(|pair| pair[0] < pair[1]);
                grow && distances.iter().all(|&distance| distance > 0.0 && distance.is_finite())
            }
            LodChoice::Automatic { levels } => *levels > 0,
        };
        let is_biased = self.bias > 0.0 && self.bias.is_finite();
        if !good || !is_biased || !(0.0..1.0).contains(&self.hysteresis) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_have_hysteresis() {
        let lods = LodSet::new([10.0, 20.0, 40.0]);
        assert_eq!(lods.level_at(5.0, 0), 0);
        assert_eq!(lods.level_at(10.5, 0), 0);
        assert_eq!(lods.level_at(10.5, 1), 1);
        assert_eq!(lods.level_at(11.5, 0), 1);
        assert_eq!(lods.level_at(100.0, 0), 3);
        assert_eq!(lods.level_at(1.0, 3), 0);
        assert_eq!(lods.pinned_to(2).level_at(1.0, 3), 2);
    }
}
