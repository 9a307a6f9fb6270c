//! Häggström's figure 6.2: time of a tick over the number of flags, at each level.

use std::thread;

use bunting_solver::StepSettings;
use serde::Serialize;

use super::{Effort, LEVELS, scheme_name, schemes};
use crate::{fleet::Fleet, scenes::Scene};

/// Numbers of flags.
const CLOTHS: [usize; 6] = [1, 8, 16, 64, 256, 1000];

/// Flags of one level, all ticked once.
#[derive(Clone, Debug, Serialize)]
pub struct Sheet {
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
}

/// Every number of flags at every level with every scheme, on one core and on all.
pub fn measure(effort: &Effort, mut done: impl FnMut()) -> Vec<Sheet> {
    let mut sheets = Vec::new();
    for settings in schemes() {
        for n in LEVELS {
            for cloths in CLOTHS.into_iter().filter(|&cloths| cloths <= effort.most_cloths) {
                for cores in core_counts() {
                    sheets.push(sheet(n, cloths, cores, settings, effort));
                    done();
                }
            }
        }
    }
    sheets
}

/// How many sheets will be measured.
#[must_use]
pub fn count(effort: &Effort) -> usize {
    let sizes = CLOTHS.into_iter().filter(|&cloths| cloths <= effort.most_cloths).count();
    schemes().len() * LEVELS.len() * sizes * core_counts().len()
}

/// One core, and all if there are more.
#[must_use]
pub fn core_counts() -> Vec<usize> {
    let all = thread::available_parallelism().map_or(1, usize::from);
    if all > 1 { vec![1, all] } else { vec![1] }
}

fn sheet(n: u32, cloths: usize, cores: usize, settings: StepSettings, effort: &Effort) -> Sheet {
    let time = Fleet::new(Scene::flag(n as usize), cloths, settings).time_ticks(cores, effort);
    Sheet {
        n,
        cloths,
        cores,
        scheme: scheme_name(settings),
        substeps: settings.substeps,
        ms_per_tick: time.median() * 1e-3,
        ms_min: time.min() * 1e-3,
    }
}
