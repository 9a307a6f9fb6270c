//! What the gate asks of each cloth at random.

use std::panic;

use super::trial::{Asked, Figures, of_seed, time_to_build};
use crate::{contacts::Row, stats::worse};

/// Seeds of the cloths that the gate tries.
pub const SEEDS: std::ops::Range<u64> = 0..96;

/// Greatest RMS speed at the end, m/s. Larger: cloth visibly moves.
const SPEED: f64 = 5e-3;
/// Greatest time of building over the number of particles, s: ten times what it takes in a debug build on a busy machine.
/// Larger: meshes that hang an app pass.
const BUILD: f64 = 5e-3;
/// Times that a mesh is built anew which took longer, as other programs use the machine, too.
const BUILDS: usize = 2;

/// Rows of the cloth of a seed: whether it is sound, how long it takes to build, and how fast it is at rest. A mesh that is
/// refused, or panics, has the first row only.
#[must_use]
pub fn verdicts(seed: u64) -> Vec<Row> {
    let trial = panic::catch_unwind(|| of_seed(seed, Asked::default()));
    let figures = trial.ok().and_then(|trial| trial.outcome.ok());
    let stretch = figures.as_ref().map_or(f64::NAN, |it| worse(it.stretch[0], it.stretch[1]));
    let row = |aspect: &str, quantity, figure, limit| {
        Row::new(format!("seed {seed}: {aspect}"), quantity, figure, limit, 0.0)
    };
    let sound = row("is a cloth", "stretch, if it is built and finite", stretch, f64::INFINITY);
    let Some(figures) = figures else { return vec![sound] };
    let build = row("time to build", "s a particle", build(seed, &figures), BUILD);
    vec![sound, build.of_times(), row("at rest", "RMS speed, m/s", figures.speed, SPEED)]
}

/// Time of building over the number of particles, s.
fn build(seed: u64, figures: &Figures) -> f64 {
    let particles = figures.particles as f64;
    let again = (0..BUILDS).map(|_| time_to_build(seed) / particles);
    let first = figures.build / particles;
    if first <= BUILD { first } else { again.fold(first, f64::min) }
}
