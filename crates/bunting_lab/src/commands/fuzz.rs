//! Cloths at random.

use std::{collections::BTreeMap, ops::Range};

use clap::Args;
use serde_json::json;

use super::progress;
use crate::{
    fuzz::{self, Trial},
    output::{
        Outcome,
        table::{Table, figure},
    },
    parallel, stats,
};

/// Speeds at the end above which cloths are counted, mm/s.
const SPEEDS: [f64; 3] = [1.0, 5.0, 20.0];
/// Strains of an edge at the end above which cloths are counted.
const STRAINS: [f64; 2] = [0.3, 1.0];
/// Strain of an edge in wind above which cloths are counted.
const BLOWN: f64 = 1.0;
/// Cloths that are listed for each figure.
const LISTED: usize = 12;

/// Which cloths.
#[derive(Clone, Debug, Args)]
pub struct Selection {
    /// Seed of the first.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// How many.
    #[arg(long, default_value_t = 300)]
    count: u64,
}

/// Tries them.
#[must_use]
pub fn run(Selection { first, count }: &Selection) -> Outcome {
    let trials = trials(*first..first + count);
    let tables = vec![summary(&trials), worst(&trials), refused(&trials)];
    Outcome { json: json!({ "trials": trials }), tables, plots: Vec::new() }
}

fn trials(seeds: Range<u64>) -> Vec<Trial> {
    let seeds: Vec<u64> = seeds.collect();
    let bar = progress(seeds.len());
    let trials = parallel::map(&seeds, |seed| {
        let trial = fuzz::of_seed(*seed);
        bar.inc(1);
        trial
    });
    bar.finish_and_clear();
    trials
}

/// Counts and medians of each family of meshes and what solves it.
fn summary(trials: &[Trial]) -> Table {
    let mut groups: BTreeMap<(String, &str), Vec<&Trial>> = BTreeMap::new();
    for trial in trials.iter().filter(|trial| trial.refused.is_none()) {
        let family = format!("{:?}", trial.family);
        groups.entry((family, &trial.solver)).or_default().push(trial);
        groups.entry(("all".into(), "")).or_default().push(trial);
    }
    Table {
        name: "fuzz".into(),
        title: format!("{} cloths at random", trials.len()),
        headers: vec![
            "meshes",
            "solved by",
            "cloths",
            "> 1; 5; 20 mm/s",
            "edge > 30; 100 % at rest",
            "> 100 % in wind",
            "mean strain in wind, %",
            "99.9 %",
            "ns a particle",
            "of a substep",
            "ms to build",
        ],
        rows: groups.into_iter().map(|((family, solver), of)| group(family, solver, &of)).collect(),
    }
}

fn group(family: String, solver: &str, trials: &[&Trial]) -> Vec<String> {
    let count =
        |is: &dyn Fn(&Trial) -> bool| trials.iter().filter(|trial| is(trial)).count().to_string();
    let counts = |limits: &[f64], of: &dyn Fn(&Trial) -> f64| {
        // What is not a number exceeds all.
        let exceeds = |figure: f64, limit: f64| figure.is_nan() || figure > limit;
        let over = |limit: &f64| count(&|trial: &Trial| exceeds(of(trial), *limit));
        limits.iter().map(over).collect::<Vec<_>>().join("; ")
    };
    let median = |of: &dyn Fn(&Trial) -> f64| {
        let mut figures: Vec<f64> = trials.iter().map(|trial| of(trial)).collect();
        figures.sort_by(f64::total_cmp);
        figure(stats::percentile(&figures, 0.5))
    };
    vec![
        family,
        solver.into(),
        trials.len().to_string(),
        counts(&SPEEDS, &|it| it.speed * 1e3),
        counts(&STRAINS, &|it| it.stretch[1]),
        counts(&[BLOWN], &|it| it.stretch[0]),
        median(&|it| it.blown.mean * 100.0),
        median(&|it| it.blown.p999 * 100.0),
        median(&|it| it.tick * 1e9),
        median(&|it| it.tick * 1e9 / f64::from(it.effort[0])),
        median(&|it| it.build * 1e3),
    ]
}

/// The cloths that move fastest, and those with the most strained edges.
fn worst(trials: &[Trial]) -> Table {
    let figures: [fn(&Trial) -> f64; 3] = [|it| it.speed, |it| it.stretch[1], |it| it.stretch[0]];
    let mut rows = Vec::new();
    for of in figures {
        let mut sorted: Vec<&Trial> = trials.iter().filter(|it| it.refused.is_none()).collect();
        sorted.sort_by(|a, b| of(b).total_cmp(&of(a)));
        rows.extend(sorted.into_iter().take(LISTED).map(row));
    }
    Table {
        name: "fuzz_worst".into(),
        title:
            "The fastest at the end, and those with the most strained edges at the end, and in wind"
                .into(),
        headers: vec![
            "seed",
            "mesh",
            "solved by",
            "particles",
            "effort",
            "mm/s",
            "edge at rest, %",
            "in wind, %",
            "ns a particle",
        ],
        rows,
    }
}

fn row(trial: &Trial) -> Vec<String> {
    let [substeps, passes] = trial.effort;
    vec![
        trial.seed.to_string(),
        format!("{:?}", trial.family),
        trial.solver.clone(),
        trial.particles.to_string(),
        format!("{substeps} × {passes}"),
        figure(trial.speed * 1e3),
        figure(trial.stretch[1] * 100.0),
        figure(trial.stretch[0] * 100.0),
        figure(trial.tick * 1e9),
    ]
}

/// Meshes that are no cloth, by the reason.
fn refused(trials: &[Trial]) -> Table {
    let refused = trials.iter().filter_map(|trial| Some((trial, trial.refused.as_ref()?)));
    Table {
        name: "fuzz_refused".into(),
        title: "Meshes that are no cloth".into(),
        headers: vec!["seed", "mesh", "error"],
        rows: refused
            .map(|(it, error)| vec![it.seed.to_string(), format!("{:?}", it.family), error.clone()])
            .collect(),
    }
}
