//! What is saved of the surface of a cloth that is read and shown.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::cloth::state::{ClothState, ReplacedSurface};
use crate::display::easing::ClothEasing;
use crate::display::lifting::ClothLift;
use crate::fabric::levels::ClothLevels;

/// The surface of a cloth after its last tick.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedSurface {
    level: usize,
    /// m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    positions: Vec<Vec3>,
    /// m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    previous_positions: Vec<Vec3>,
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    normals: Vec<Vec3>,
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    previous_normals: Vec<Vec3>,
    moved: bool,
    is_skinned: bool,
    replaced: Option<ReplacedSurface>,
    /// While a change of level is eased.
    easing: Option<ClothEasing>,
    lift: Option<ClothLift>,
}

impl SavedSurface {
    /// The surface of a cloth.
    pub fn of(cloth: EntityRef, state: &ClothState) -> Self {
        let easing = cloth.get::<ClothEasing>().filter(|easing| easing.is_active());
        Self {
            level: state.level,
            positions: state.positions.clone(),
            previous_positions: state.previous_positions.clone(),
            normals: state.normals.clone(),
            previous_normals: state.previous_normals.clone(),
            moved: state.moved,
            is_skinned: state.is_skinned,
            replaced: state.replaced.clone(),
            easing: easing.cloned(),
            lift: cloth.get::<ClothLift>().cloned(),
        }
    }

    /// Whether the surface is one of a cloth with these levels.
    pub fn is_of(&self, levels: &ClothLevels) -> bool {
        let lists =
            [&self.positions, &self.previous_positions, &self.normals, &self.previous_normals];
        let replaced = self.replaced.as_ref().map_or(0, |replaced| replaced.level);
        if self.level >= levels.count() || replaced >= levels.count() {
            return false;
        }
        let count = levels.fabric(self.level).particle_count();
        lists.iter().all(|list| list.len() == count)
    }

    /// Shows the surface. Of cloth that no frame shows, what frames need is left out.
    pub fn show(&self, cloth: &mut EntityWorldMut, levels: &Arc<ClothLevels>) {
        if let Some(mut state) = cloth.get_mut::<ClothState>() {
            let state = &mut *state;
            state.level = self.level;
            state.positions.clone_from(&self.positions);
            state.previous_positions.clone_from(&self.previous_positions);
            state.normals.clone_from(&self.normals);
            state.previous_normals.clone_from(&self.previous_normals);
            (state.moved, state.is_skinned) = (self.moved, self.is_skinned);
            state.replaced.clone_from(&self.replaced);
            state.levels = Some(Arc::clone(levels));
        }
        if let Some(mut easing) = cloth.get_mut::<ClothEasing>() {
            let saved = self.easing.clone().and_then(|saved| saved.of_levels(levels));
            *easing = saved.unwrap_or_default();
        }
        if let Some(mut lift) = cloth.get_mut::<ClothLift>() {
            *lift = self.lift.clone().unwrap_or_default();
        }
    }
}
