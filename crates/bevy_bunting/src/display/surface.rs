//! The displayed surface of a cloth between two ticks.

use bevy_app::{App, Plugin, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::{Time, Virtual};

use crate::cloth::state::ClothState;
use crate::display::easing::ClothEasing;
use crate::display::lifting::ClothLift;
use crate::schedule::{ClothSystems, ClothTick};

/// The displayed surface of a cloth, in the cloth's frame: [`ClothState`] interpolated between its last two
/// ticks, one tick before the time of the frame.
///
/// Rigid vertices, of weight 0, have no particles: they stay where the
/// [`ClothMesh`](crate::ClothMesh) has them, see [`ClothState::particle_of_vertex`].
///
/// After a change of level the surface continues its motion with the vertices of the finer level, and
/// approaches the surface of the new level within 0.25 s.
///
/// Where a triangle between particles would cut a solid [`ClothCollider`](crate::ClothCollider), the surface
/// is lifted out of the collider.
///
/// Optional: only cloths with this component are interpolated. It is written in each frame, in
/// `RunFixedMainLoopSystems::AfterFixedMainLoop`.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(ClothEasing, ClothLift)]
pub struct ClothSurface {
    /// Positions of the particles, m.
    pub positions: Vec<Vec3>,
    /// Unit normals of the particles, to the front.
    pub normals: Vec<Vec3>,
    pub(crate) level: usize,
}

impl ClothSurface {
    /// The level of detail whose particles the surface has.
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

/// End and length of the last tick, s.
#[derive(Resource, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct LastTick {
    end: f64,
    length: f64,
}

impl LastTick {
    /// The same tick on a clock that reads so many seconds more.
    pub fn moved_by(self, time: f64) -> Self {
        Self { end: self.end + time, ..self }
    }

    /// The fraction of the last tick whose surfaces are shown now.
    pub fn fraction(&self, time: &Time<Virtual>) -> f32 {
        if self.length <= 0.0 {
            return 1.0;
        }
        ((time.elapsed_secs_f64() - self.end) / self.length).clamp(0.0, 1.0) as f32
    }
}

fn note_tick(mut tick: ResMut<LastTick>, time: Res<Time>) {
    *tick = LastTick { end: time.elapsed_secs_f64(), length: time.delta_secs_f64() };
}

fn interpolate_surfaces(
    mut surfaces: Query<(&ClothState, &ClothEasing, &ClothLift, &mut ClothSurface)>,
    tick: Res<LastTick>,
    time: Res<Time<Virtual>>,
) {
    let fraction = tick.fraction(&time);
    for (state, easing, lift, mut surface) in &mut surfaces {
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
        surface.positions.extend(interpolate(from, to, fraction));
        lift.apply(level, fraction, &mut surface.positions);
        surface.normals.clear();
        let normals = interpolate(normals[0], normals[1], fraction);
        surface.normals.extend(normals.map(Vec3::normalize_or_zero));
    }
}

fn interpolate<'a>(
    from: &'a [Vec3],
    to: &'a [Vec3],
    fraction: f32,
) -> impl Iterator<Item = Vec3> + 'a {
    from.iter().zip(to).map(move |(from, to)| from.lerp(*to, fraction))
}
