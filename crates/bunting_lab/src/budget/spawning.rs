//! Two hundred flags of different sizes, spawned at once in front of a camera: each needs a fabric of its
//! own.

use bevy_app::App;
use bevy_bunting::{Attachment, ClothEdge, ClothMesh};
use bevy_bunting::{ClothBudget, LodSet, LodViewer};
use bevy_transform::components::Transform;
use glam::Vec3;
use serde::Serialize;

use crate::{game, scenes::TICK_RATE, settings::steps_of_levels, timing::Timing};

/// Number of flags.
const FLAGS: usize = 200;
/// Particles a side at the finest level, and number of levels.
const SIDE: u32 = 33;
const LEVELS: usize = 4;
/// Flags in a row.
const ROW: usize = 20;
/// Difference in width from one flag to the next, m.
const DIFFERENCE: f32 = 1e-3;
/// Length of the measurement, s.
const SECONDS: usize = 6;
/// Length of a quick measurement, s.
const QUICK_SECONDS: usize = 1;

/// Costs of spawning.
#[derive(Clone, Debug, Serialize)]
pub struct Spawning {
    /// The budget of a tick, ms.
    pub ms_budget: f64,
    /// The first tick, ms.
    pub ms_first: f64,
    /// 95th percentile of the plugin's ticks after the first, ms.
    pub ms_p95: f64,
    /// 95th percentile in the second in which it is greatest, ms.
    pub ms_p95_worst_second: f64,
    /// The slowest tick after the first, ms.
    pub ms_worst: f64,
    /// Time until all flags are simulated, s; none if some never are.
    pub seconds_to_all: Option<f64>,
}

/// Spawns the flags and measures in real time, since fabrics are built on another thread.
#[must_use]
pub fn measure(quick: bool) -> Spawning {
    let mut app = game::app_in_wind(steps_of_levels());
    app.update();
    spawn_flags(&mut app);
    let ticks = TICK_RATE as usize * if quick { QUICK_SECONDS } else { SECONDS };
    let (mut times, mut ms_first, mut seconds_to_all) = (Timing::default(), 0.0, None);
    for tick in 0..ticks {
        let time = game::update_in_real_time(&mut app);
        if tick == 0 {
            ms_first = time * 1e3;
        } else {
            times.push(time * 1e6);
        }
        if seconds_to_all.is_none() && game::built(&mut app) == FLAGS {
            seconds_to_all = Some((tick + 1) as f64 / f64::from(TICK_RATE));
        }
    }
    Spawning {
        ms_budget: app.world().resource::<ClothBudget>().tick.as_secs_f64() * 1e3,
        ms_first,
        ms_p95: times.percentile(0.95) / 1e3,
        ms_p95_worst_second: times.worst_percentile(TICK_RATE as usize, 0.95) / 1e3,
        ms_worst: times.percentile(1.0) / 1e3,
        seconds_to_all,
    }
}

fn spawn_flags(app: &mut App) {
    let view = Transform::from_xyz(0.0, 3.0, 12.0);
    app.world_mut().spawn((LodViewer::default(), view));
    for flag in 0..FLAGS {
        let (column, row) = ((flag % ROW) as f32 - 0.5 * ROW as f32, (flag / ROW) as f32);
        let place = Transform::from_translation(Vec3::new(1.5 * column, 0.0, -2.0 * row));
        let mesh = ClothMesh::grid(SIDE, SIDE, 1.0 + DIFFERENCE * flag as f32, 1.0);
        let held = Attachment::in_place(ClothEdge::Left);
        app.world_mut().spawn((mesh, held, LodSet::automatic(LEVELS), place));
    }
}
