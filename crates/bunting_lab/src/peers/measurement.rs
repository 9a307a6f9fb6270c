//! Measurements of each engine.

use serde::Serialize;

use super::{engine::Engine, peer::Peer};
use crate::{
    reference::grid::Grid,
    scenes::{Scene, TICK_RATE, ticks},
    simulation::in_double,
    stats::{self, Strain},
    timing::Timing,
};

/// Ticks before time is taken.
const WARM_UP: usize = 3;
/// Sideways jump of the cloth's supports, m.
const TELEPORT: f32 = 10.0;
/// Length of the hitch, a single long tick, s.
const HITCH: f32 = 0.5;
/// Longest time for recovery, s.
const RECOVERY_TIME: f64 = 5.0;
/// Greatest excess of a link's strain over its value before the disturbance at which a cloth has recovered.
const RECOVERED: f64 = 0.02;

/// One engine on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Engine.
    pub engine: &'static str,
    /// Description of the engine's constraints.
    pub constraints: &'static str,
    /// Scene.
    pub scene: &'static str,
    /// Vertices along each side.
    pub n: usize,
    /// Substeps a tick.
    pub substeps: u32,
    /// Cloths advanced at once.
    pub lanes: usize,
    /// Median time of a tick of one cloth, ms.
    pub ms_per_tick: f64,
    /// Shortest time of a tick of one cloth, ms.
    pub ms_min: f64,
    /// Mean of |ε| over warp and weft at rest.
    pub mean_stretch: Option<f64>,
    /// Maximum of |ε| over warp and weft at rest.
    pub max_stretch: Option<f64>,
    /// Root mean square velocity at the end, m/s.
    pub final_speed: Option<f64>,
}

/// Effect of a disturbance on one engine.
#[derive(Clone, Debug, Serialize)]
pub struct Shock {
    /// Engine.
    pub engine: &'static str,
    /// Substeps a tick.
    pub substeps: u32,
    /// Name of the disturbance.
    pub shock: &'static str,
    /// Whether all positions stayed finite.
    pub finite: bool,
    /// Time of the tick with the disturbance, ms, of all lanes.
    pub ms: f64,
    /// Largest |ε| over warp and weft from that tick on.
    pub worst_stretch: Option<f64>,
    /// Time until no link is much longer than before the disturbance, s; none if that takes more than 5 s.
    pub recovery_s: Option<f64>,
}

/// Runs the scene to its end.
#[must_use]
pub fn hang(engine: &Engine, scene: &Scene) -> Row {
    let grid = Grid::new(scene);
    let mut cloth = (engine.start)(scene);
    let mut time = Timing::default();
    let (mut means, mut largest) = (Vec::new(), 0.0_f64);
    for tick in 0..scene.ticks() {
        if tick < WARM_UP {
            cloth.tick();
        } else {
            time.time(|| cloth.tick());
        }
        if tick >= scene.window_start() {
            let strain = strain(&grid, cloth.as_ref());
            means.push(strain.mean);
            largest = largest.max(strain.max);
        }
    }
    Row {
        engine: engine.name,
        constraints: engine.constraints,
        scene: scene.name,
        n: scene.columns,
        substeps: engine.substeps,
        lanes: engine.lanes,
        ms_per_tick: time.median() * 1e-3 / engine.lanes as f64,
        ms_min: time.min() * 1e-3 / engine.lanes as f64,
        mean_stretch: finite(stats::mean(&means)),
        max_stretch: finite(largest),
        final_speed: finite(stats::rms_length(&in_double(cloth.velocities()))),
    }
}

/// Disturbs the cloth at rest in two separate runs: by a teleport, and by one tick of half a second.
#[must_use]
pub fn shocks(engine: &Engine, scene: &Scene) -> Vec<Shock> {
    let teleport = |cloth: &mut dyn Peer| cloth.teleport(TELEPORT);
    let hitch = |cloth: &mut dyn Peer| cloth.hitch(HITCH);
    vec![
        shock(engine, scene, "teleport by 10 m", teleport),
        shock(engine, scene, "hitch of 0.5 s", hitch),
    ]
}

fn shock(
    engine: &Engine,
    scene: &Scene,
    name: &'static str,
    happen: impl Fn(&mut dyn Peer),
) -> Shock {
    let grid = Grid::new(scene);
    let mut cloth = (engine.start)(scene);
    (0..scene.ticks()).for_each(|_| cloth.tick());
    let recovered = strain(&grid, cloth.as_ref()).max + RECOVERED;
    let mut time = Timing::default();
    time.time(|| happen(cloth.as_mut()));
    let mut worst = 0.0_f64;
    let mut recovery = None;
    for tick in 0..ticks(RECOVERY_TIME) {
        let strain = strain(&grid, cloth.as_ref()).max;
        // `f64::max` would ignore a value that is not a number.
        worst = if strain.is_finite() { worst.max(strain) } else { f64::INFINITY };
        if strain > recovered || !strain.is_finite() {
            recovery = None;
        } else if recovery.is_none() {
            recovery = Some(tick as f64 / f64::from(TICK_RATE));
        }
        cloth.tick();
    }
    Shock {
        engine: engine.name,
        substeps: engine.substeps,
        shock: name,
        finite: cloth.positions().iter().all(|x| x.is_finite()),
        ms: time.median() * 1e-3,
        worst_stretch: finite(worst),
        recovery_s: recovery,
    }
}

fn strain(grid: &Grid, cloth: &dyn Peer) -> Strain {
    Strain::of(grid.strains(&in_double(cloth.positions())))
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
