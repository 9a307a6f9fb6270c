//! The surface for display, between two ticks.

use bevy_app::{App, Plugin, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::{Time, Virtual};

use crate::cloth::state::ClothState;
use crate::display::easing::ClothEasing;
use crate::schedule::{ClothSystems, ClothTick};

/// The surface of a cloth for display, in the cloth's frame: [`ClothState`] between its last two
/// ticks, by how far the frame is past the last.
///
/// Vertices that are rigid, of weight 0, have no particles: they stay where the
/// [`ClothMesh`](crate::ClothMesh) has them, see [`ClothState::particle_of_vertex`].
///
/// After a change of level it goes on from the surface before, with the vertices of the finer level,
/// and becomes that of the new level within 0.25 s.
///
/// Optional: only cloths that have it pay for it. Written each frame in
/// `RunFixedMainLoopSystems::AfterFixedMainLoop`.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(ClothEasing)]
pub struct ClothSurface {
    /// Positions of the particles, m.
    pub positions: Vec<Vec3>,
    /// Unit normals of the particles, to the front.
    pub normals: Vec<Vec3>,
    pub(crate) level: usize,
}

impl ClothSurface {
    /// The level of detail whose particles it has.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }
}

/// Interpolates [`ClothSurface`]s.
#[derive(Debug, Default)]
pub struct SurfacePlugin;

impl Plugin for SurfacePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothSurface>()
            .init_resource::<LastTick>()
            .add_systems(ClothTick, note_tick.in_set(ClothSystems::Publish))
            .add_systems(
                RunFixedMainLoop,
                interpolate_surfaces.in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            );
    }
}

/// When the last tick ended, and how long it was, s.
#[derive(Resource, Debug, Default)]
struct LastTick {
    end: f64,
    length: f64,
}

fn note_tick(mut tick: ResMut<LastTick>, time: Res<Time>) {
    *tick = LastTick { end: time.elapsed_secs_f64(), length: time.delta_secs_f64() };
}

fn interpolate_surfaces(
    mut surfaces: Query<(&ClothState, &ClothEasing, &mut ClothSurface)>,
    tick: Res<LastTick>,
    time: Res<Time<Virtual>>,
) {
    let part =
        if tick.length > 0.0 { (time.elapsed_secs_f64() - tick.end) / tick.length } else { 1.0 };
    let part = part.clamp(0.0, 1.0) as f32;
    for (state, easing, mut surface) in &mut surfaces {
        let (level, [from, to], normals) = match easing.level() {
            Some(level) => (
                level,
                [&easing.previous_positions, &easing.positions],
                [&easing.previous_normals, &easing.normals],
            ),
            None => (
                state.level,
                [&state.previous_positions, &state.positions],
                [&state.previous_normals, &state.normals],
            ),
        };
        surface.level = level;
        surface.positions.clear();
        surface.positions.extend(between(from, to, part));
        surface.normals.clear();
        let normals = between(normals[0], normals[1], part);
        surface.normals.extend(normals.map(Vec3::normalize_or_zero));
    }
}

fn between<'a>(from: &'a [Vec3], to: &'a [Vec3], part: f32) -> impl Iterator<Item = Vec3> + 'a {
    from.iter().zip(to).map(move |(from, to)| from.lerp(*to, part))
}
