//! The eased surface of a cloth while its level changes.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{Vec3, ops};

use crate::cloth::state::{ClothState, ReplacedSurface};
use crate::display::decay::Decay;
use crate::fabric::levels::ClothLevels;

/// Time after which the new level's own surface is shown, s. Shorter: changes of level are visible as jerks.
/// Longer: they cost more, and the shown surface lags behind the simulated one.
pub(super) const DURATION: f32 = 0.25;

/// Power of the relative age by which the offsets are faded out in addition to their decay: large enough to
/// leave the first frames unchanged, small enough not to jerk the last ones.
const FADE: f32 = 4.0;

/// The surface of a cloth while its level changes: the surface of the new level, plus offsets that decay to
/// zero ("inertialization", Bollo 2018).
///
/// At the change, the offsets are the differences between the shown surface and that of the new level, and
/// their rates are the differences of the velocities, so that neither positions nor velocities of the shown
/// surface jump. The surface has the vertices of the finest level that takes part.
#[derive(Component, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClothEasing {
    /// The levels of the cloth while a change is eased; none otherwise.
    #[cfg_attr(feature = "serialize", serde(skip))]
    levels: Option<Arc<ClothLevels>>,
    /// The level whose vertices the surface has.
    level: usize,
    /// Time since the last change of level, s.
    age: f32,
    /// Offsets of positions (m), one a particle.
    offsets: Vec<Decay>,
    normal_offsets: Vec<Decay>,
    /// Positions after the last tick, m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub positions: Vec<Vec3>,
    /// Positions before the last tick, m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub previous_positions: Vec<Vec3>,
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub normals: Vec<Vec3>,
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub previous_normals: Vec<Vec3>,
}

impl ClothEasing {
    /// The level whose vertices the surface has; none while no change is eased.
    pub fn level(&self) -> Option<usize> {
        self.is_active().then_some(self.level)
    }

    /// The easing of a cloth with these levels, when it was saved. None if it does not fit them.
    pub fn of_levels(mut self, levels: &Arc<ClothLevels>) -> Option<Self> {
        let count = levels.fabric(self.level).particle_count();
        let is_of_surface =
            [&self.offsets, &self.normal_offsets].iter().all(|it| it.len() == count)
                && [&self.positions, &self.normals].iter().all(|it| it.len() == count);
        self.levels = Some(Arc::clone(levels));
        is_of_surface.then_some(self)
    }

    pub fn is_active(&self) -> bool {
        self.levels.is_some()
    }

    /// Ends the easing if the cloth has other levels by now.
    pub(super) fn keep_only_for(&mut self, levels: Option<&Arc<ClothLevels>>) {
        let is_same = |eased: &Arc<ClothLevels>| levels.is_some_and(|it| Arc::ptr_eq(eased, it));
        self.levels = self.levels.take().filter(is_same);
    }

    /// Begins to ease a change of level, after a tick of `tick` seconds at the new level.
    pub(super) fn begin(
        &mut self,
        replaced: ReplacedSurface,
        levels: &Arc<ClothLevels>,
        state: &ClothState,
        tick: f32,
    ) {
        if !self.is_active() {
            self.level = replaced.level;
            self.positions = replaced.positions;
            self.previous_positions = replaced.previous_positions;
            self.normals = replaced.normals;
            self.offsets.clear();
            self.normal_offsets.clear();
        }
        // The surface has the vertices of the finer of the two levels from here on.
        let finer = self.level.min(state.level);
        let refine =
            |values: &[Vec3], from: usize| levels.interpolate(values.to_vec(), from, finer);
        let [shown, shown_before, shown_normals] =
            [&self.positions, &self.previous_positions, &self.normals]
                .map(|values| refine(values, self.level));
        let [new_before, new, new_normals] =
            [&state.previous_positions, &state.positions, &state.previous_normals]
                .map(|values| refine(values, state.level));
        let accelerations = |offsets: &[Decay]| {
            let accelerations: Vec<Vec3> = offsets.iter().map(|it| it.acceleration).collect();
            if accelerations.is_empty() {
                vec![Vec3::ZERO; shown.len()]
            } else {
                refine(&accelerations, self.level)
            }
        };
        let (acceleration, normal_acceleration) =
            (accelerations(&self.offsets), accelerations(&self.normal_offsets));
        self.offsets = (0..shown.len())
            .map(|at| Decay {
                value: shown[at] - new_before[at],
                rate: ((shown[at] - shown_before[at]) - (new[at] - new_before[at])) / tick,
                acceleration: acceleration[at],
            })
            .collect();
        self.normal_offsets = (0..shown.len())
            .map(|at| Decay {
                value: shown_normals[at] - new_normals[at],
                rate: Vec3::ZERO,
                acceleration: normal_acceleration[at],
            })
            .collect();
        self.positions = shown;
        self.normals = shown_normals;
        self.level = finer;
        self.age = 0.0;
        self.levels = Some(Arc::clone(levels));
    }

    /// Computes the surface at the end of a tick of `tick` seconds.
    pub(super) fn advance(&mut self, levels: &ClothLevels, state: &ClothState, tick: f32) {
        if self.age + tick > DURATION {
            self.levels = None;
            return;
        }
        self.age += tick;
        let refine = |values: &[Vec3]| levels.interpolate(values.to_vec(), state.level, self.level);
        let (positions, normals) = (refine(&state.positions), refine(&state.normals));
        self.previous_positions = core::mem::take(&mut self.positions);
        self.previous_normals = core::mem::take(&mut self.normals);
        let fade = 1.0 - ops::powf(self.age / DURATION, FADE);
        let eased = |(value, offset): (Vec3, &mut Decay)| {
            offset.advance(tick);
            value + offset.value * fade
        };
        self.positions = positions.into_iter().zip(&mut self.offsets).map(eased).collect();
        let normals = normals.into_iter().zip(&mut self.normal_offsets).map(eased);
        self.normals = normals.map(Vec3::normalize_or_zero).collect();
    }
}
