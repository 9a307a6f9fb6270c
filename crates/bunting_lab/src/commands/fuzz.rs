//! Cloths at random.

use std::{collections::BTreeMap, ops::Range};

use clap::Args;
use serde_json::json;

use super::progress;
use crate::{
    fuzz::{self, Figures, Trial},
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

/// The trials of meshes that are cloths, with their figures.
fn measured(trials: &[Trial]) -> impl Iterator<Item = (&Trial, &Figures)> {
    trials.iter().filter_map(|trial| Some((trial, trial.outcome.as_ref().ok()?)))
}

/// Counts and medians of each family of meshes and what solves it.
fn summary(trials: &[Trial]) -> Table {
    let mut groups: BTreeMap<(String, &str), Vec<&Figures>> = BTreeMap::new();
    for (trial, figures) in measured(trials) {
        let family = format!("{:?}", trial.family);
        groups.entry((family, &figures.solver)).or_default().push(figures);
        groups.entry(("all".into(), "")).or_default().push(figures);
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

fn group(family: String, solver: &str, cloths: &[&Figures]) -> Vec<String> {
    let counts = |limits: &[f64], of: &dyn Fn(&Figures) -> f64| {
        // What is not a number exceeds all.
        let exceeds = |figure: f64, limit: f64| figure.is_nan() || figure > limit;
        let over = |limit: &f64| cloths.iter().filter(|it| exceeds(of(it), *limit)).count();
        limits.iter().map(|limit| over(limit).to_string()).collect::<Vec<_>>().join("; ")
    };
    let median = |of: &dyn Fn(&Figures) -> f64| {
        let mut figures: Vec<f64> = cloths.iter().map(|it| of(it)).collect();
        figures.sort_by(f64::total_cmp);
        figure(stats::percentile(&figures, 0.5))
    };
    vec![
        family,
        solver.into(),
        cloths.len().to_string(),
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
    let figures: [fn(&Figures) -> f64; 3] = [|it| it.speed, |it| it.stretch[1], |it| it.stretch[0]];
    let mut rows = Vec::new();
    for of in figures {
        let mut sorted: Vec<(&Trial, &Figures)> = measured(trials).collect();
        sorted.sort_by(|(_, a), (_, b)| of(b).total_cmp(&of(a)));
        rows.extend(sorted.into_iter().take(LISTED).map(|(trial, figures)| row(trial, figures)));
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

fn row(trial: &Trial, figures: &Figures) -> Vec<String> {
    let [substeps, passes] = figures.effort;
    vec![
        trial.seed.to_string(),
        format!("{:?}", trial.family),
        figures.solver.clone(),
        figures.particles.to_string(),
        format!("{substeps} × {passes}"),
        figure(figures.speed * 1e3),
        figure(figures.stretch[1] * 100.0),
        figure(figures.stretch[0] * 100.0),
        figure(figures.tick * 1e9),
    ]
}

/// Meshes that are no cloth, by the reason.
fn refused(trials: &[Trial]) -> Table {
    let refused = trials.iter().filter_map(|trial| Some((trial, trial.outcome.as_ref().err()?)));
    Table {
        name: "fuzz_refused".into(),
        title: "Meshes that are no cloth".into(),
        headers: vec!["seed", "mesh", "error"],
        rows: refused
            .map(|(it, error)| vec![it.seed.to_string(), format!("{:?}", it.family), error.clone()])
            .collect(),
    }
}
