//! A thousand flags around a moving camera, through the plugin and its levels of detail, on one core.

use std::f32::consts::TAU;

use bevy_bunting::{ClothCounts, ClothSystems, ClothTimings, LodSet, LodViewer};
use bevy_transform::components::Transform;
use bunting_solver::StepSettings;
use glam::Vec3;
use serde::Serialize;

use super::{LEVELS, scheme_name};
use crate::{game, scenes::TICK_RATE, stats, timing::Timing};

/// Flags in the field.
const FLAGS: usize = 1000;
/// Flags stand on a sunflower's spiral, k-th at this times √k from its middle, m: one on 20 m².
const SPACING: f32 = 2.5;
/// Turn from one flag to the next as a part of a full one: the golden section's.
const GOLDEN: f32 = 0.381_966;
/// Distances from each level to the next coarser one, m.
pub const DISTANCES: [f32; 3] = [8.0, 16.0, 32.0];
/// Radius of the camera's path, m.
const PATH: f32 = 40.0;
/// Height of the camera above the poles' tops, m.
const HEIGHT: f32 = 1.0;
/// Speed of the camera, m/s.
const SPEED: f32 = 10.0;
/// Ticks before time is taken.
const WARM_UP: usize = 30;
/// Length of the flight, s: once round the path.
const SECONDS: usize = 25;
/// The same where it is to be quick.
const QUICK_SECONDS: usize = 2;

/// Times of an update of the app.
#[derive(Clone, Debug, Serialize)]
pub struct Thousand {
    /// Scheme.
    pub scheme: &'static str,
    /// Substeps a tick.
    pub substeps: u32,
    /// Median, ms.
    pub ms_median: f64,
    /// 95th percentile, ms.
    pub ms_p95: f64,
    /// Mean over the slowest second, ms.
    pub ms_worst_second: f64,
    /// Mean number of flags at each level, the finest first.
    pub per_level: Vec<f64>,
    /// Median time of each of the plugin's sets, in their order, ms.
    pub ms_per_set: Vec<f64>,
    /// Changes of level a tick, at least: by the change of the numbers.
    pub changes_per_tick: f64,
}

/// Flies the camera once round.
#[must_use]
pub fn measure(settings: StepSettings, quick: bool) -> Thousand {
    let mut app = game::app(settings);
    for flag in 0..FLAGS {
        let (angle, radius) = (TAU * GOLDEN * flag as f32, SPACING * (flag as f32).sqrt());
        let at = Vec3::new(radius * angle.cos(), 0.0, radius * angle.sin());
        game::spawn_flag(&mut app, LEVELS[0], at, LodSet::new(DISTANCES));
    }
    let camera = app.world_mut().spawn((LodViewer, Transform::default())).id();
    let seconds = if quick { QUICK_SECONDS } else { SECONDS };
    let mut time = Timing::default();
    let mut sets: [Timing; ClothSystems::ORDER.len()] = Default::default();
    let mut counts: Vec<Vec<usize>> = Vec::new();
    for tick in 0..WARM_UP + seconds * TICK_RATE as usize {
        let angle = SPEED / PATH * tick as f32 / TICK_RATE as f32;
        let place = Vec3::new(PATH * angle.cos(), HEIGHT, PATH * angle.sin());
        *app.world_mut().get_mut::<Transform>(camera).expect("the camera stays") =
            Transform::from_translation(place);
        if tick < WARM_UP {
            app.update();
        } else {
            time.time(|| app.update());
            let timings = app.world().resource::<ClothTimings>();
            for (time, set) in sets.iter_mut().zip(ClothSystems::ORDER) {
                time.push(timings.of(set).as_secs_f64() * 1e6);
            }
            counts.push(app.world().resource::<ClothCounts>().0.clone());
        }
    }
    let at_level = |count: &Vec<usize>, level: usize| count.get(level).copied().unwrap_or(0);
    let per_level = (0..LEVELS.len()).map(|level| {
        let flags: Vec<f64> = counts.iter().map(|count| at_level(count, level) as f64).collect();
        stats::mean(&flags)
    });
    let changed = |pair: &[Vec<usize>]| {
        let moved = |level| at_level(&pair[0], level).abs_diff(at_level(&pair[1], level));
        (0..LEVELS.len()).map(moved).sum::<usize>() as f64 / 2.0
    };
    let changes: Vec<f64> = counts.windows(2).map(changed).collect();
    Thousand {
        scheme: scheme_name(settings),
        substeps: settings.substeps,
        ms_median: time.median() * 1e-3,
        ms_p95: time.percentile(0.95) * 1e-3,
        ms_worst_second: time.worst_mean(TICK_RATE as usize) * 1e-3,
        per_level: per_level.collect(),
        ms_per_set: sets.iter().map(|time| time.median() * 1e-3).collect(),
        changes_per_tick: stats::mean(&changes),
    }
}
