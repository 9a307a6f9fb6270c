//! Häggström's figure 6.2: time of a tick over the number of flags, at each level.

use std::thread;

use bunting_solver::StepSettings;
use serde::Serialize;

use crate::{
    effort::Effort,
    fleet::Fleet,
    scenes::Scene,
    settings::{LEVELS, scheme_name, schemes},
};

/// Numbers of flags.
const CLOTHS: [usize; 6] = [1, 8, 16, 64, 256, 1000];

/// Flags of one level, each stepped by one tick.
#[derive(Clone, Debug, Serialize)]
pub struct ManyFlags {
    /// Vertices along each side.
    pub n: u32,
    /// Number of flags.
    pub cloths: usize,
    /// Number of threads.
    pub cores: usize,
    /// Scheme.
    pub scheme: &'static str,
    /// Substeps a tick.
    pub substeps: u32,
    /// Median time of a tick, ms.
    pub ms_per_tick: f64,
    /// Shortest time of a tick, ms.
    pub ms_min: f64,
    /// Shortest time on one core divided by the shortest time on `cores` cores.
    pub over_one_core: f64,
}

/// Measures every number of flags at every level with every scheme, on one core and on all.
pub fn measure(effort: &Effort, mut done: impl FnMut()) -> Vec<ManyFlags> {
    let mut many_flags = Vec::new();
    for settings in schemes() {
        for n in LEVELS {
            for cloths in CLOTHS.into_iter().filter(|&cloths| cloths <= effort.most_cloths) {
                many_flags.extend(on_all_cores(n, cloths, settings, effort));
                done();
            }
        }
    }
    many_flags
}

/// Number of times that `measure` calls `done`.
#[must_use]
pub fn count(effort: &Effort) -> usize {
    let sizes = CLOTHS.into_iter().filter(|&cloths| cloths <= effort.most_cloths).count();
    schemes().len() * LEVELS.len() * sizes
}

/// Numbers of cores that are measured: one, and all if there are more.
fn core_counts() -> Vec<usize> {
    let all = thread::available_parallelism().map_or(1, usize::from);
    if all > 1 { vec![1, all] } else { vec![1] }
}

/// Measures the same flags on one core and on all.
fn on_all_cores(n: u32, cloths: usize, settings: StepSettings, effort: &Effort) -> Vec<ManyFlags> {
    let cores = core_counts();
    let times = Fleet::new(Scene::flag(n as usize), cloths, settings).time_ticks(&cores, effort);
    let alone = times[0].min();
    let many_flags = cores.iter().zip(&times).map(|(&cores, time)| ManyFlags {
        n,
        cloths,
        cores,
        scheme: scheme_name(settings),
        substeps: settings.substeps,
        ms_per_tick: time.median() * 1e-3,
        ms_min: time.min() * 1e-3,
        over_one_core: alone / time.min(),
    });
    many_flags.collect()
}
