//! Eight flags at a distance from the viewer, through the plugin: time over distance, with levels chosen by
//! their visible error, in place of time over level in Häggström's figure 6.2.

use std::time::Duration;

use bevy_bunting::{ClothBudget, ClothCounts, ClothTimings, LodSet, LodViewer};
use bevy_transform::components::Transform;
use glam::Vec3;
use serde::Serialize;

use super::thesis::FLAGS;
use crate::{
    game,
    settings::{LEVELS, steps_of_levels},
    timing::Timing,
};

/// Distances of the flags from the viewer, m.
const DISTANCES: [f32; 8] = [2.5, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0];
/// Ticks until every cloth has found its level: three changes from the coarsest to the finest, each half a
/// second after the one before.
const WARM_UP: usize = 240;
/// Ticks that are timed.
const TICKS: usize = 240;
/// Ticks that are timed in a quick run.
const QUICK_TICKS: usize = 30;
/// Budget that keeps no level coarse, a tick.
const BUDGET: Duration = Duration::from_secs(1);

/// Eight flags at one distance.
#[derive(Clone, Debug, Serialize)]
pub struct AtDistance {
    /// Distance from the viewer, m.
    pub distance_m: f64,
    /// Flags at each level, the finest first.
    pub per_level: Vec<usize>,
    /// Median time of the plugin's tick, ms.
    pub ms_per_tick: f64,
}

/// Measures every distance.
#[must_use]
pub fn measure(quick: bool) -> Vec<AtDistance> {
    DISTANCES.map(|distance| at(distance, if quick { QUICK_TICKS } else { TICKS })).into()
}

fn at(distance: f32, ticks: usize) -> AtDistance {
    let mut app = game::app_in_wind(steps_of_levels());
    app.insert_resource(ClothBudget { tick: BUDGET, ..ClothBudget::default() });
    let levels = LEVELS.len();
    // The flags stand in two rows of four, 1.5 m apart, in the middle of the picture.
    for flag in 0..FLAGS {
        let [column, row] = [flag % 4, flag / 4].map(|k| k as f32);
        let at = Vec3::new(1.5 * (column - 2.0), 1.5 * row, 0.0);
        game::spawn_flag(&mut app, LEVELS[0], at, LodSet::automatic(levels));
    }
    app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, distance)));
    (0..WARM_UP).for_each(|_| app.update());
    let mut time = Timing::default();
    for _ in 0..ticks {
        app.update();
        time.push(app.world().resource::<ClothTimings>().total().as_secs_f64() * 1e6);
    }
    let counts = app.world().resource::<ClothCounts>();
    AtDistance {
        distance_m: distance.into(),
        per_level: (0..levels).map(|level| counts.0.get(level).copied().unwrap_or(0)).collect(),
        ms_per_tick: time.median() * 1e-3,
    }
}
