//! Effects of a change of level on a flag in the wind.
//!
//! Flags fly on at one level while copies of them change to the next, tick after tick. Momentum and energy
//! are compared before and after the transfer alone. The pop is the visible jump without easing: the distance
//! between the two surfaces one tick later, at the finer level's vertices.

use bunting_solver::{ClothSnapshot, LevelTransfer, StepSettings};
use glam::{DVec3, Vec3};
use serde::Serialize;

use crate::{
    fleet::Fleet,
    levels::{FLAGS, INTERVAL, SETTLING, pops::PIXELS},
    product,
    reference::grid::Grid,
    scenes::{GRAVITY, Scene, ticks},
    settings::scheme_name,
    simulation::in_double,
    stats::{self, worse},
};

/// Jumps of one change of level, over many moments of a flight.
#[derive(Clone, Debug, Serialize)]
pub struct Switch {
    /// Scheme.
    pub scheme: &'static str,
    /// Vertices along each side before.
    pub from: usize,
    /// Vertices along each side after.
    pub to: usize,
    /// Root mean square pop, m.
    pub pop_rms_m: f64,
    /// Largest pop of a vertex, m, averaged over the moments.
    pub pop_max_m: f64,
    /// Distance in metres from which on the largest pop is less than a pixel.
    pub invisible_from_m: f64,
    /// Mean change of the momentum, over the sum of the magnitudes of all particles' momenta.
    pub momentum_jump: f64,
    /// Greatest change of the momentum, over the momentum.
    pub momentum_worst: f64,
    /// Mean change of kinetic energy, over the kinetic energy; signed.
    pub kinetic_jump: f64,
    /// Mean change of kinetic, elastic and potential energy, over the kinetic energy; signed.
    pub energy_jump: f64,
    /// Greatest growth of kinetic, elastic and potential energy, over the kinetic energy.
    pub energy_worst: f64,
}

/// One change of one flag.
struct Jump {
    pop_rms: f64,
    pop_max: f64,
    momentum: f64,
    momentum_of_sum: f64,
    kinetic: f64,
    energy: f64,
}

impl Jump {
    /// Jump of a cloth, from the distances (m) of its vertices from their positions without a change, and its
    /// motion before and after.
    fn new(moved: &[f64], [old, new]: [Motion; 2]) -> Self {
        let momentum = (new.momentum - old.momentum).length();
        Self {
            pop_rms: stats::mean(&moved.iter().map(|d| d * d).collect::<Vec<_>>()).sqrt(),
            pop_max: moved.iter().copied().fold(0.0, worse),
            momentum: momentum / old.momentum_magnitudes,
            momentum_of_sum: momentum / old.momentum.length(),
            kinetic: (new.kinetic - old.kinetic) / old.kinetic,
            energy: (new.total - old.total) / old.kinetic,
        }
    }
}

impl Switch {
    /// Changes flags from `from` to `to` vertices a side, the next level, at `moments` moments.
    ///
    /// # Panics
    ///
    /// When the two levels are not neighbours.
    #[must_use]
    pub fn of(from: usize, to: usize, settings: StepSettings, moments: usize) -> Self {
        let mut flying = Fleet::new(Scene::flag(from), FLAGS, settings);
        let mut changed = Fleet::new(Scene::flag(to), FLAGS, settings);
        let [fine, coarse] = [from.max(to), from.min(to)].map(|n| product::fabric(&Scene::flag(n)));
        let transfer = LevelTransfer::between(&fine, &coarse).expect("neighbours");
        let material = product::material(&Scene::flag(from));
        let gravity = Vec3::NEG_Y * Scene::flag(from).gravity as f32;
        let change = |state: &ClothSnapshot| {
            if to < from {
                transfer.restrict(state, &material, gravity)
            } else {
                transfer.prolong(state, &material, gravity)
            }
        };
        // Both surfaces are compared at the finer level's vertices.
        let refined = |state: ClothSnapshot| -> Vec<Vec3> {
            let is_coarse = state.positions.len() == coarse.particle_count();
            if is_coarse { transfer.spread(&state.positions).collect() } else { state.positions }
        };
        let grids = [from, to].map(|n| Grid::new(&Scene::flag(n)));
        flying.advance(ticks(SETTLING));
        let mut jumps = Vec::new();
        for _ in 0..moments {
            flying.advance(ticks(INTERVAL));
            let before: Vec<_> = flying.snapshots().collect();
            changed.take_over(&flying, change);
            let after: Vec<_> = changed.snapshots().collect();
            flying.advance(1);
            changed.advance(1);
            let surfaces = flying.snapshots().zip(changed.snapshots());
            for ((before, after), (stayed, changed)) in before.iter().zip(&after).zip(surfaces) {
                let moved = distances(&refined(stayed), &refined(changed));
                let motions = [(&grids[0], before), (&grids[1], after)].map(Motion::of);
                jumps.push(Jump::new(&moved, motions));
            }
        }
        let average =
            |figure: fn(&Jump) -> f64| stats::mean(&jumps.iter().map(figure).collect::<Vec<f64>>());
        let most =
            |figure: fn(&Jump) -> f64| jumps.iter().map(figure).fold(f64::NEG_INFINITY, worse);
        let pop_max_m = average(|jump| jump.pop_max);
        Self {
            scheme: scheme_name(settings),
            from,
            to,
            pop_rms_m: average(|jump| jump.pop_rms),
            pop_max_m,
            invisible_from_m: pop_max_m * PIXELS,
            momentum_jump: average(|jump| jump.momentum),
            momentum_worst: most(|jump| jump.momentum_of_sum),
            kinetic_jump: average(|jump| jump.kinetic),
            energy_jump: average(|jump| jump.energy),
            energy_worst: most(|jump| jump.energy),
        }
    }
}

fn distances(a: &[Vec3], b: &[Vec3]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| f64::from(a.distance(*b))).collect()
}

/// Momentum and energy of a cloth, as computed by the reference.
struct Motion {
    /// Momentum, kg·m/s.
    momentum: DVec3,
    /// Sum of the magnitudes of all particles' momenta, kg·m/s.
    momentum_magnitudes: f64,
    /// Kinetic energy, J.
    kinetic: f64,
    /// Kinetic, elastic and potential energy, J.
    total: f64,
}

impl Motion {
    fn of((grid, state): (&Grid, &ClothSnapshot)) -> Self {
        let positions = in_double(&state.positions);
        let velocities = in_double(&state.velocities);
        let momenta = || velocities.iter().zip(&grid.masses).map(|(&v, &mass)| v * mass);
        let kinetic = grid.kinetic_energy(&velocities);
        let height = grid.gravity_energy(GRAVITY, &positions);
        Self {
            momentum: momenta().sum(),
            momentum_magnitudes: momenta().map(DVec3::length).sum(),
            kinetic,
            total: kinetic + grid.elastic_energy(&positions) + height,
        }
    }
}
