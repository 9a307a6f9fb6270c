//! Time of one constraint and of one triangle in the wind, by differences.
//!
//! The solver's phases can be timed, its kernels cannot. Each figure is therefore the difference of two runs
//! of one phase that differ only in how often the kernel runs:
//!
//! - A **constraint** of Gauss–Seidel: the time of `solve_constraints` with four passes minus that with two
//!   is the time of two sweeps over all hinges and links. A hinge costs more than a link; the figure is their
//!   mean.
//! - A **constraint** of the yarns: the same difference is the time of two more solutions of the warp and
//!   weft yarns and one more sweep over warp and weft, that is of three visits to every such link.
//! - A **triangle**: the time of `integrate` of flags in the wind minus that of flags in a vacuum.
//!
//! All figures are per cloth of a full batch of the widest lanes.

use bunting_solver::{Link, LinkFamily, Scheme, StepSettings};
use serde::Serialize;

use super::phases::full_batch;
use crate::{
    effort::Effort,
    fleet::Fleet,
    product::TICK,
    scenes::{Air, Scene},
    timing::Timing,
};

/// Vertices along each side of the flags.
const SIZE: usize = 33;
/// Numbers of passes that are compared. Both store multipliers; a single pass would not.
const PASSES: [u32; 2] = [2, 4];

/// Times of kernels, ns per cloth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Kernels {
    /// A link of the warp and weft yarns.
    pub ns_per_constraint: f64,
    /// A link or hinge of a Gauss–Seidel sweep.
    pub ns_per_constraint_gauss_seidel: f64,
    /// A triangle of the air.
    pub ns_per_wind_triangle: f64,
}

/// Measures all kernels.
#[must_use]
pub fn measure(effort: &Effort) -> Kernels {
    let yarns = StepSettings::yarns(2);
    let sweeps = StepSettings::gauss_seidel(2);
    Kernels {
        ns_per_constraint: ns_per_constraint(yarns, effort),
        ns_per_constraint_gauss_seidel: ns_per_constraint(sweeps, effort),
        ns_per_wind_triangle: ns_per_wind_triangle(yarns, effort),
    }
}

fn flags(scene: Scene, settings: StepSettings, effort: &Effort) -> Fleet {
    let mut fleet = Fleet::new(scene, full_batch(), settings);
    fleet.advance(effort.warm_up);
    fleet
}

fn ns_per_constraint(settings: StepSettings, effort: &Effort) -> f64 {
    let mut fleet = flags(Scene::flag(SIZE), settings, effort);
    let fabric = fleet.fabric();
    let projections = match settings.scheme {
        Scheme::GaussSeidel => 2 * (fabric.links().len() + fabric.hinge_count()),
        Scheme::Yarns => {
            let diagonal = |link: &&Link| link.family == LinkFamily::Diagonal;
            3 * (fabric.links().len() - fabric.links().iter().filter(diagonal).count())
        }
    };
    let mut times: [Timing; PASSES.len()] = Default::default();
    // The two runs alternate, so that both see the same load of the machine.
    for _ in 0..effort.ticks(1e3) {
        for (passes, time) in PASSES.into_iter().zip(&mut times) {
            fleet.drive();
            let batch = &mut fleet.batches_mut()[0];
            batch.begin_tick(TICK, StepSettings { passes, ..settings });
            for _ in 0..settings.substeps {
                batch.integrate();
                time.time(|| batch.solve_constraints());
                batch.update_velocities();
            }
        }
    }
    let [few, many] = times.map(|time| time.median());
    (many - few) * 1e3 / (projections * full_batch()) as f64
}

fn ns_per_wind_triangle(settings: StepSettings, effort: &Effort) -> f64 {
    let scene = Scene::flag(SIZE);
    let scenes = [scene.clone(), Scene { air: Air::VACUUM, ..scene }];
    let mut fleets = scenes.map(|scene| flags(scene, settings, effort));
    let triangles = fleets[0].fabric().triangles().len();
    let mut times: [Timing; 2] = Default::default();
    // The two runs alternate, so that both see the same load of the machine.
    for _ in 0..effort.ticks(1e3) {
        for (fleet, time) in fleets.iter_mut().zip(&mut times) {
            fleet.drive();
            let batch = &mut fleet.batches_mut()[0];
            batch.begin_tick(TICK, settings);
            for _ in 0..settings.substeps {
                time.time(|| batch.integrate());
                batch.solve_constraints();
                batch.update_velocities();
            }
        }
    }
    let [with_air, without] = times.map(|time| time.median());
    (with_air - without) * 1e3 / (triangles * full_batch()) as f64
}
