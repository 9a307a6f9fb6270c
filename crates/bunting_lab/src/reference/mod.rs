//! The converged reference: the same continuum scene in double precision.
//!
//! [`grid`] states the discrete model, [`verlet`] integrates it at a step that resolves its stiffest spring,
//! [`relaxation`] finds its rest state, and [`xpbd`] checks both by a method that shares neither the
//! integrator nor the forces.

pub mod cache;
pub mod forces;
pub mod grid;
pub mod relaxation;
pub mod verlet;
pub mod xpbd;

use serde::{Deserialize, Serialize};

use crate::{
    observation::{COMPARED_TICKS, Observation, Observer},
    scenes::{Measure, Scene, TICK_RATE},
    stats::Strain,
};
use grid::Grid;
use verlet::{Verlet, resolving_steps};

/// Force in newtons below which a cloth of the standard scenes (2 N of weight) is at rest.
pub const REST_FORCE: f64 = 1e-9;
/// Greatest number of steps for coming to rest.
const REST_STEPS: usize = 2_000_000;

/// A reference run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// Steps a tick; twice as many for the compared positions.
    pub steps: usize,
    /// Observation of the run. For a scene measured at rest, strain and tip are those of static equilibrium.
    pub observation: Observation,
    /// Distance of the positions at `COMPARED_TICKS` from those at half as many steps, m RMS. Large after a
    /// flat cloth has buckled, since its motion is chaotic from then on.
    pub step_errors: Vec<f64>,
    /// Largest residual force on a vertex, N, if the scene is measured at rest.
    pub residual: Option<f64>,
}

impl Reference {
    /// The reference of a scene, from the cache if it is there.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let steps = match scene.measure {
            Measure::Positions => resolving_steps(&Grid::new(scene)),
            // The rest state does not depend on the step, and statistics hide the step's error.
            Measure::Rest | Measure::Statistics => resolving_steps(&Grid::new(scene)) / 2,
        };
        cache::cached(&(scene, steps), || Self::run(scene, steps))
    }

    /// Runs the scene at `steps` steps a tick; up to the last compared positions also at twice as many.
    #[must_use]
    pub fn run(scene: &Scene, steps: usize) -> Self {
        let mut cloth = Verlet::new(scene, steps);
        let mut observation = observe(&mut cloth, scene.ticks(), scene);
        let compared = scene.ticks().min(COMPARED_TICKS[COMPARED_TICKS.len() - 1]);
        let fine = observe(&mut Verlet::new(scene, 2 * steps), compared, scene);
        let step_errors =
            (0..fine.compared.len()).filter_map(|k| observation.rms_error(&fine, k)).collect();
        observation.compared = fine.compared;
        let residual = (scene.measure == Measure::Rest).then(|| {
            let step = 1.0 / (f64::from(TICK_RATE) * steps as f64);
            let residual = cloth.relax(step, REST_FORCE, REST_STEPS);
            observation.strain = Strain::of(cloth.grid().strains(&cloth.positions));
            observation.tip = cloth.positions[cloth.positions.len() - 1];
            residual
        });
        Self { steps, observation, step_errors, residual }
    }
}

/// Advances a cloth by some ticks of its scene and observes it.
fn observe(cloth: &mut Verlet, ticks: usize, scene: &Scene) -> Observation {
    let grid = cloth.grid().clone();
    let mut observer = Observer::new(scene, &grid);
    for _ in 0..ticks {
        cloth.tick();
        observer.observe(&cloth.positions, &cloth.velocities);
    }
    observer.finish()
}
