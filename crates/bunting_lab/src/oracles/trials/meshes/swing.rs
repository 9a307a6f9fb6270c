//! Meshes that swing by an edge, beside the grid.

use bunting_solver::{FabricMaterial, StepSettings};
use glam::{DVec3, Vec3};

use super::cloth::Cloth;
use super::limits::bound;
use super::materials::{ISOTROPIC, STANDARD};
use super::square::{TRIANGULATIONS, at_top, square};
use crate::{meshes::Triangulation, oracles::Case, product::TICK, stats::mean};

/// Distance of the swing's mean from the grid's that passes, m, after 0.4 s.
const SWING: f64 = 5e-3;
/// How much farther than the grid a mesh may be from its converged motion.
const UNCONVERGED: f64 = 2.0;
/// Difference of a period from the grid's that passes, relative.
const PERIOD: f64 = 5e-3;
/// Substeps and passes of the converged motion.
const CONVERGED: StepSettings = StepSettings { substeps: 16, passes: 4, ..StepSettings::yarns(2) };
/// Angle from the vertical at which a swing begins, rad. Larger: cloth folds, and two motions part for good.
const START: f32 = 0.5;
/// Length of the motion that is compared, s.
const SECONDS: usize = 4;

/// All swings.
pub(super) fn cases() -> Vec<Case> {
    let (of_grid, level_grid) = (Swing::new(None), level_mean(None));
    let of_mesh = |triangulation| {
        let swing = Swing::new(Some(triangulation));
        let name = format!("mesh swings by an edge, {triangulation:?}");
        let level = level_mean(Some(triangulation)).distance(level_grid);
        let period = (swing.period / of_grid.period - 1.0).abs();
        [
            bound(format!("{name}, mean after 0.4 s against the grid's, m"), SWING, level),
            bound(
                format!("{name}, RMS error against the grid's, m"),
                UNCONVERGED * of_grid.error,
                swing.error,
            ),
            bound(format!("{name}, period against the grid's"), PERIOD, period),
        ]
    };
    TRIANGULATIONS.into_iter().flat_map(of_mesh).collect()
}

/// Where the mean of a cloth is 0.4 s after it was level, m.
fn level_mean(triangulation: Option<Triangulation>) -> DVec3 {
    let fabric = square(triangulation, 33, 0.0, at_top);
    let material = FabricMaterial { damping: 0.0, ..STANDARD };
    let mut cloth = Cloth::new(fabric, material, |at| Vec3::new(at.x, 0.0, -at.y));
    cloth.run(0.4);
    cloth.mean(|_| true)
}

/// What a swing from a small angle shows.
struct Swing {
    /// Distance from the converged motion of the same cloth, m RMS over particles and ticks.
    error: f64,
    /// Mean time of a swing to and fro, s.
    period: f64,
}

impl Swing {
    fn new(triangulation: Option<Triangulation>) -> Self {
        let fabric = square(triangulation, 33, 0.0, at_top);
        let material = FabricMaterial { damping: 0.0, ..ISOTROPIC };
        let (sin, cos) = START.sin_cos();
        let start = |at: Vec3| Vec3::new(at.x, at.y * cos, at.y * sin);
        let mut cloth = Cloth::new(fabric.clone(), material, start);
        let mut converged = Cloth::new(fabric, material, start);
        let (mut squares, mut across) = (Vec::new(), Vec::new());
        for _ in 0..(SECONDS as f32 / TICK) as usize {
            cloth.tick();
            converged.tick_by(CONVERGED);
            let pairs = cloth.positions.iter().zip(&converged.positions);
            squares.extend(pairs.map(|(at, exact)| f64::from(at.distance_squared(*exact))));
            across.push(cloth.mean(|_| true).z);
        }
        Self { error: mean(&squares).sqrt(), period: period(&across) }
    }
}

/// Mean period of an oscillation about zero, s, from its values after each tick.
fn period(values: &[f64]) -> f64 {
    let ticks = values.windows(2).enumerate();
    let crossings: Vec<f64> = ticks
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(tick, pair)| tick as f64 + pair[0] / (pair[0] - pair[1]))
        .collect();
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    2.0 * f64::from(TICK) * (last - first) / (crossings.len() - 1) as f64
}
