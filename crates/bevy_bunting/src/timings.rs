//! Times of the sets of a tick.

use std::time::Duration;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;

use crate::schedule::{ClothSystems, ClothTick};

/// Time that each set of the last [`ClothTick`] took, including systems that users added to it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClothTimings {
    sets: [Duration; ClothSystems::ORDER.len()],
}

impl ClothTimings {
    /// Time that a set took.
    #[must_use]
    pub fn of(&self, set: ClothSystems) -> Duration {
        self.sets[set as usize]
    }

    /// Time that all sets took.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.sets.iter().sum()
    }
}

/// Start of the set that is running.
#[derive(Resource)]
struct SetStart(Instant);

/// The systems that measure the sets. The last of them runs after all sets.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MeasureSystems;

/// Adds the systems that measure the sets.
pub(crate) fn measure_sets(app: &mut App) {
    let [prepare, select, drive, step, normals, publish] = ClothSystems::ORDER;
    app.init_resource::<ClothTimings>().insert_resource(SetStart(Instant::now())).add_systems(
        ClothTick,
        (
            start.before(prepare),
            end::<0>.after(prepare).before(select),
            end::<1>.after(select).before(drive),
            end::<2>.after(drive).before(step),
            end::<3>.after(step).before(normals),
            end::<4>.after(normals).before(publish),
            end::<5>.after(publish).in_set(MeasureSystems),
        ),
    );
}

fn start(mut start: ResMut<SetStart>) {
    start.0 = Instant::now();
}

fn end<const SET: usize>(mut start: ResMut<SetStart>, mut timings: ResMut<ClothTimings>) {
    let now = Instant::now();
    timings.sets[SET] = now - start.0;
    start.0 = now;
}
