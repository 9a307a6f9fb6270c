//! The same cloth at each level: hung, swung and flown.

use std::f64::consts::PI;

use bunting_solver::{ClothSnapshot, StepSettings};
use glam::{DVec3, Vec3};
use serde::Serialize;

use crate::{
    fleet::Fleet,
    levels::FLAGS,
    product::Product,
    scenes::{Scene, TICK_RATE, ticks},
    settings::scheme_name,
    simulation::Simulation,
    stats,
};

/// Tilt from which the hung sheet swings, rad: small, so that its period is that of its modes.
const TILT: f32 = PI as f32 / 36.0;
/// Length of the swing, s.
const SWING_SECONDS: f64 = 10.0;

/// Figures of one level.
#[derive(Clone, Debug, Serialize)]
pub struct Agreement {
    /// Scheme.
    pub scheme: &'static str,
    /// Vertices along each side.
    pub n: usize,
    /// Depth of the middle of the lower edge of a sheet hung from two corners, m.
    pub droop_m: f64,
    /// Period of a hung sheet let go at 5°, s.
    pub swing_period_s: f64,
    /// Mean position of a flag's lower free corner, m.
    pub tip_m: DVec3,
    /// Standard deviation of the corner's position, m.
    pub tip_spread_m: f64,
    /// Frequency at which the corner flutters across the wind, Hz.
    pub flutter_hz: f64,
}

impl Agreement {
    /// Measures a level. In a quick run, flags fly for a quarter of the time.
    #[must_use]
    pub fn of(n: usize, settings: StepSettings, quick: bool) -> Self {
        let (tip_m, tip_spread_m, flutter_hz) = fly(n, settings, quick);
        Self {
            scheme: scheme_name(settings),
            n,
            droop_m: droop(n, settings),
            swing_period_s: swing_period(n, settings),
            tip_m,
            tip_spread_m,
            flutter_hz,
        }
    }
}

fn droop(n: usize, settings: StepSettings) -> f64 {
    let scene = Scene::hang_corners(n);
    let mut cloth = Product::lone(settings).start(&scene);
    (0..scene.ticks()).for_each(|_| cloth.tick());
    -f64::from(cloth.positions()[(n - 1) * n + n / 2].y)
}

fn swing_period(n: usize, settings: StepSettings) -> f64 {
    let scene = Scene { damping: 0.0, ..Scene::hang_top(n) };
    let mut cloth = Product::lone(settings).start(&scene);
    let (sine, cosine) = TILT.sin_cos();
    let tilted = |x: &Vec3| Vec3::new(x.x, x.y * cosine, -x.y * sine);
    let positions: Vec<Vec3> = cloth.positions().iter().map(tilted).collect();
    let velocities = vec![Vec3::ZERO; positions.len()];
    cloth.restore(&ClothSnapshot::new(positions, velocities));
    let tip: Vec<f64> = (0..ticks(SWING_SECONDS))
        .map(|_| {
            cloth.tick();
            f64::from(cloth.positions()[n * n - 1].z)
        })
        .collect();
    stats::crossing_frequency(&tip, f64::from(TICK_RATE)).map_or(f64::NAN, f64::recip)
}

/// Mean, spread and frequency of the tips of some flags, averaged over the flags.
fn fly(n: usize, settings: StepSettings, quick: bool) -> (DVec3, f64, f64) {
    let scene = Scene::flag(n);
    let (settling, end) = (scene.window_start(), scene.ticks());
    let watched = if quick { (end - settling) / 4 } else { end - settling };
    let mut fleet = Fleet::new(scene, FLAGS, settings);
    fleet.advance(settling);
    let mut paths = vec![Vec::new(); FLAGS];
    for _ in 0..watched {
        fleet.advance(1);
        for (path, flag) in paths.iter_mut().zip(fleet.snapshots()) {
            path.push(flag.positions[n * n - 1].as_dvec3());
        }
    }
    let tips: Vec<DVec3> = paths.iter().map(|path| mean(path)).collect();
    let squared: Vec<f64> = paths
        .iter()
        .zip(&tips)
        .flat_map(|(path, tip)| path.iter().map(|x| x.distance_squared(*tip)))
        .collect();
    let frequencies: Vec<f64> = paths
        .iter()
        .filter_map(|path| {
            let across: Vec<f64> = path.iter().map(|x| x.z).collect();
            stats::crossing_frequency(&across, f64::from(TICK_RATE))
        })
        .collect();
    (mean(&tips), stats::mean(&squared).sqrt(), stats::mean(&frequencies))
}

fn mean(positions: &[DVec3]) -> DVec3 {
    positions.iter().sum::<DVec3>() / positions.len() as f64
}
