//! Eases the displayed surface across a change of level.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::{Vec3, ops};
use bevy_time::Time;

use crate::batch::publish::publish_states;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::{ClothState, Left};
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::schedule::{ClothSystems, ClothTick};

/// Time after which the level's own surface is shown, s.
const DURATION: f32 = 0.25;

/// How fast the difference between the two surfaces goes, 1/s: 3 % of it is left at the end, and faded out.
/// Larger: the surface jerks. Smaller: what changes again and again lags behind.
const RATE: f32 = 28.0;

/// Power of the time with which the rest fades out: late, so that the first frames do not notice, and not at
/// once.
const FADE: f32 = 4.0;

/// The surface of a cloth while its level changes: that of the new level, and what the surface before
/// was beyond it, which is taken off smoothly ("inertialization", Bollo 2018). It goes on as it
/// moved, so nothing pops, and however often the level changes it stays near.
///
/// It is shown with the vertices of the finest level that takes part.
#[derive(Component, Debug, Default)]
pub(crate) struct ClothEasing {
    /// The chain, while there is something to ease.
    levels: Option<Arc<ClothLevels>>,
    /// The level whose vertices are shown.
    level: usize,
    /// Since the last change of level, s.
    age: f32,
    beyond: Vec<Decay>,
    normals_beyond: Vec<Decay>,
    pub positions: Vec<Vec3>,
    pub previous_positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub previous_normals: Vec<Vec3>,
}

/// Eases surfaces.
#[derive(Debug, Default)]
pub struct EasingPlugin;

impl Plugin for EasingPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            ease_surfaces.in_set(ClothSystems::Publish).after(publish_states),
        );
    }
}

pub(crate) fn ease_surfaces(
    mut cloths: Query<(&ClothInstance, &mut ClothState, &mut ClothEasing), With<ClothSurface>>,
    time: Res<Time>,
) {
    for (instance, mut state, mut easing) in &mut cloths {
        let Some(levels) = &instance.levels else {
            easing.levels = None;
            continue;
        };
        if easing.levels.as_ref().is_some_and(|eased| !Arc::ptr_eq(eased, levels)) {
            easing.levels = None;
        }
        if state.left.is_some() {
            let left = state.bypass_change_detection().left.take();
            left.into_iter().for_each(|left| easing.begin(left, levels, &state, time.delta_secs()));
        }
        if easing.is_active() {
            easing.advance(levels, &state, time.delta_secs());
        }
    }
}

impl ClothEasing {
    /// The level whose vertices are shown, while there is something to ease.
    pub fn level(&self) -> Option<usize> {
        self.is_active().then_some(self.level)
    }

    fn is_active(&self) -> bool {
        self.levels.is_some()
    }

    /// The level has changed in this tick of `tick` seconds.
    fn begin(&mut self, left: Left, levels: &Arc<ClothLevels>, state: &ClothState, tick: f32) {
        if !self.is_active() {
            self.level = left.level;
            self.positions = left.positions;
            self.previous_positions = left.previous_positions;
            self.normals = left.normals;
            self.beyond.clear();
            self.normals_beyond.clear();
        }
        let shown = self.level.min(state.level);
        let raise = |values: &[Vec3], from: usize| levels.spread(values.to_vec(), from, shown);
        let [now, before, normals] = [&self.positions, &self.previous_positions, &self.normals]
            .map(|v| raise(v, self.level));
        let [start, end, bare] =
            [&state.previous_positions, &state.positions, &state.previous_normals]
                .map(|values| raise(values, state.level));
        let kept = |decays: &[Decay]| {
            let accelerations: Vec<Vec3> = decays.iter().map(|decay| decay.acceleration).collect();
            if accelerations.is_empty() {
                vec![Vec3::ZERO; now.len()]
            } else {
                raise(&accelerations, self.level)
            }
        };
        let (kept_beyond, kept_normals) = (kept(&self.beyond), kept(&self.normals_beyond));
        self.beyond = (0..now.len())
            .map(|at| Decay {
                value: now[at] - start[at],
                rate: ((now[at] - before[at]) - (end[at] - start[at])) / tick,
                acceleration: kept_beyond[at],
            })
            .collect();
        self.normals_beyond = (0..now.len())
            .map(|at| Decay {
                value: normals[at] - bare[at],
                rate: Vec3::ZERO,
                acceleration: kept_normals[at],
            })
            .collect();
        self.positions = now;
        self.normals = normals;
        self.level = shown;
        self.age = 0.0;
        self.levels = Some(Arc::clone(levels));
    }

    /// The surface at the end of a tick of `tick` seconds.
    fn advance(&mut self, levels: &ClothLevels, state: &ClothState, tick: f32) {
        if self.age + tick > DURATION {
            self.levels = None;
            return;
        }
        self.age += tick;
        let spread = |values: &[Vec3]| levels.spread(values.to_vec(), state.level, self.level);
        let (base, normals) = (spread(&state.positions), spread(&state.normals));
        self.previous_positions = core::mem::take(&mut self.positions);
        self.previous_normals = core::mem::take(&mut self.normals);
        let fade = 1.0 - ops::powf(self.age / DURATION, FADE);
        let decayed = |(base, decay): (Vec3, &mut Decay)| {
            decay.advance(tick);
            base + decay.value * fade
        };
        self.positions = base.into_iter().zip(&mut self.beyond).map(decayed).collect();
        let turned = normals.into_iter().zip(&mut self.normals_beyond).map(decayed);
        self.normals = turned.map(Vec3::normalize_or_zero).collect();
    }
}

/// What goes to zero, smoothly even where it is pushed anew: x‴ = −3ω x″ − 3ω² x′ − ω³ x.
#[derive(Clone, Copy, Debug)]
struct Decay {
    value: Vec3,
    /// 1/s.
    rate: Vec3,
    /// 1/s².
    acceleration: Vec3,
}

impl Decay {
    /// Exactly, for a time in seconds: (a + b t + c t²) exp(−ω t).
    fn advance(&mut self, time: f32) {
        let (a, w) = (self.value, RATE);
        let b = self.rate + a * w;
        let c = 0.5 * (self.acceleration + 2.0 * w * self.rate + w * w * a);
        let left = ops::exp(-w * time);
        let (x, dx, ddx) = (a + (b + c * time) * time, b + 2.0 * c * time, 2.0 * c);
        self.value = x * left;
        self.rate = (dx - x * w) * left;
        self.acceleration = (ddx - dx * (2.0 * w) + x * (w * w)) * left;
    }
}

#[cfg(test)]
#[path = "easing_tests.rs"]
mod tests;
