//! Cloths at random.

use std::{collections::BTreeMap, ops::Range};

use clap::Args;
use serde_json::json;

use super::progress;
use crate::{
    fuzz::{self, Asked, Figures, Rest, Sag, Trial},
    output::{
        Outcome,
        table::{Table, figure},
    },
    parallel, stats,
};

/// Speeds at the end above which cloths are counted, mm/s.
const SPEEDS: [f64; 3] = [1.0, 5.0, 20.0];
/// Strains of a link at the end above which cloths are counted.
const STRAINS: [f64; 2] = [0.3, 1.0];
/// Strain of a link in wind above which cloths are counted.
const BLOWN: f64 = 1.0;
/// Errors of the sag above which cloths are counted, mm.
const SAGS: [f64; 2] = [5.0, 50.0];
/// Cloths that are listed for each figure.
const LISTED: usize = 12;
/// Headers of what tells a trial from others.
const IDENTITY: [&str; 4] = ["seed", "mesh", "particles", "effort"];

/// Which cloths.
#[derive(Clone, Debug, Args)]
pub struct Selection {
    /// Seed of the first.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// How many.
    #[arg(long, default_value_t = 300)]
    count: u64,
    /// Also let each hang without wind, and compare how far it sinks with a high effort, which takes ten times as long.
    #[arg(long)]
    sag: bool,
    /// Also let each hang without wind at the damping of a flag, and tell how fast it still is.
    #[arg(long)]
    rest: bool,
}

/// Tries them.
#[must_use]
pub fn run(&Selection { first, count, sag, rest }: &Selection) -> Outcome {
    let trials = trials(first..first + count, Asked { sag, rest });
    let mut tables = vec![summary(&trials), worst(&trials), refused(&trials)];
    if sag {
        tables.extend([sags(&trials), worst_sags(&trials)]);
    }
    if rest {
        tables.extend([rests(&trials), worst_rests(&trials)]);
    }
    Outcome { json: json!({ "trials": trials }), tables, plots: Vec::new() }
}

fn trials(seeds: Range<u64>, asked: Asked) -> Vec<Trial> {
    let seeds: Vec<u64> = seeds.collect();
    let bar = progress(seeds.len());
    let trials = parallel::map(&seeds, |seed| {
        let trial = fuzz::of_seed(*seed, asked);
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

/// Counts and medians of each family of meshes.
fn summary(trials: &[Trial]) -> Table {
    let mut groups: BTreeMap<String, Vec<&Figures>> = BTreeMap::new();
    for (trial, figures) in measured(trials) {
        groups.entry(format!("{:?}", trial.family)).or_default().push(figures);
        groups.entry("all".into()).or_default().push(figures);
    }
    Table {
        name: "fuzz".into(),
        title: format!("{} cloths at random", trials.len()),
        headers: vec![
            "meshes",
            "cloths",
            "with pieces that fall",
            "> 1; 5; 20 mm/s",
            "link > 30; 100 % at rest",
            "> 100 % in wind",
            "mean strain in wind, %",
            "99.9 %",
            "ns a particle",
            "of a substep",
            "ms to build",
        ],
        rows: groups.into_iter().map(|(family, of)| group(family, &of)).collect(),
    }
}

fn group(family: String, cloths: &[&Figures]) -> Vec<String> {
    let figures = |of: &dyn Fn(&Figures) -> f64| cloths.iter().map(|it| of(it)).collect::<Vec<_>>();
    let counts = |limits: &[f64], of: &dyn Fn(&Figures) -> f64| counts(limits, &figures(of));
    let median = |of: &dyn Fn(&Figures) -> f64| figure(percentile(figures(of), 0.5));
    vec![
        family,
        cloths.len().to_string(),
        cloths.iter().filter(|it| it.unheld > 0).count().to_string(),
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

/// How many of these figures are above each limit.
fn counts(limits: &[f64], figures: &[f64]) -> String {
    // What is not a number exceeds all.
    let exceeds = |figure: f64, limit: f64| figure.is_nan() || figure > limit;
    let over = |limit: &f64| figures.iter().filter(|figure| exceeds(**figure, *limit)).count();
    limits.iter().map(|limit| over(limit).to_string()).collect::<Vec<_>>().join("; ")
}

fn percentile(mut figures: Vec<f64>, part: f64) -> f64 {
    figures.sort_by(f64::total_cmp);
    stats::percentile(&figures, part)
}

/// How far cloths sink, beside a high effort, by their family.
fn sags(trials: &[Trial]) -> Table {
    let mut groups: BTreeMap<String, Vec<Sag>> = BTreeMap::new();
    for (trial, figures) in measured(trials) {
        groups.entry(format!("{:?}", trial.family)).or_default().extend(figures.sag);
    }
    let row = |(family, sags): (String, Vec<Sag>)| {
        let errors: Vec<f64> = sags.iter().map(|sag| sag.error() * 1e3).collect();
        let converged = sags.iter().map(|sag| sag.converged * 1e3).collect();
        let at = |part| figure(percentile(errors.clone(), part));
        vec![
            family,
            sags.len().to_string(),
            figure(percentile(converged, 0.5)),
            at(0.5),
            at(0.8),
            counts(&SAGS, &errors),
        ]
    };
    Table {
        name: "fuzz_sag".into(),
        title: "How far they sink under their weight, beside a high effort".into(),
        headers: vec!["meshes", "cloths", "sag, mm", "error, mm", "80 %", "> 5; 50 mm"],
        rows: groups.into_iter().map(row).collect(),
    }
}

/// The cloths that sink most wrongly.
fn worst_sags(trials: &[Trial]) -> Table {
    let mut sorted: Vec<(&Trial, &Figures, Sag)> =
        measured(trials).filter_map(|(trial, of)| Some((trial, of, of.sag?))).collect();
    sorted.sort_by(|(_, _, a), (_, _, b)| b.error().total_cmp(&a.error()));
    let row = |(trial, figures, sag): (&Trial, &Figures, Sag)| {
        let sags = [sag.own, sag.converged].map(|sag| figure(sag * 1e3));
        identity(trial, figures).into_iter().chain(sags).collect()
    };
    Table {
        name: "fuzz_worst_sag".into(),
        title: "Those that sink most wrongly".into(),
        headers: IDENTITY.into_iter().chain(["sag, mm", "at a high effort"]).collect(),
        rows: sorted.into_iter().take(LISTED).map(row).collect(),
    }
}

/// How fast cloths still are without wind, by their family.
fn rests(trials: &[Trial]) -> Table {
    let mut groups: BTreeMap<String, Vec<Rest>> = BTreeMap::new();
    for (trial, figures) in measured(trials) {
        groups.entry(format!("{:?}", trial.family)).or_default().extend(figures.rest);
        groups.entry("all".into()).or_default().extend(figures.rest);
    }
    let row = |(family, rests): (String, Vec<Rest>)| {
        let of_time = |time: usize| rests.iter().map(|rest| rest.speeds[time] * 1e3).collect();
        let speeds: [Vec<f64>; 2] = [0, 1].map(of_time);
        let cells = speeds
            .into_iter()
            .flat_map(|speeds| [counts(&SPEEDS, &speeds), figure(percentile(speeds, 0.5))]);
        [family, rests.len().to_string()].into_iter().chain(cells).collect()
    };
    Table {
        name: "fuzz_rest".into(),
        title: "How fast they are without wind at the damping of a flag".into(),
        headers: vec![
            "meshes",
            "cloths",
            "> 1; 5; 20 mm/s after 10 s",
            "median, mm/s",
            "after 40 s",
            "median, mm/s",
        ],
        rows: groups.into_iter().map(row).collect(),
    }
}

/// The cloths that are fastest without wind.
fn worst_rests(trials: &[Trial]) -> Table {
    let mut sorted: Vec<(&Trial, &Figures, [f64; 2])> =
        measured(trials).filter_map(|(trial, of)| Some((trial, of, of.rest?.speeds))).collect();
    sorted.sort_by(|(_, _, a), (_, _, b)| b[0].total_cmp(&a[0]));
    let row = |(trial, figures, speeds): (&Trial, &Figures, [f64; 2])| {
        identity(trial, figures).into_iter().chain(speeds.map(|it| figure(it * 1e3))).collect()
    };
    Table {
        name: "fuzz_worst_rest".into(),
        title: "Those that are fastest without wind after 10 s".into(),
        headers: IDENTITY.into_iter().chain(["mm/s after 10 s", "after 40 s"]).collect(),
        rows: sorted.into_iter().take(LISTED).map(row).collect(),
    }
}

/// The cloths that move fastest, and those with the most strained links.
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
            "The fastest at the end, and those with the most strained links at the end, and in wind"
                .into(),
        headers: IDENTITY
            .into_iter()
            .chain(["mm/s", "link at rest, %", "in wind, %", "ns a particle"])
            .collect(),
        rows,
    }
}

fn row(trial: &Trial, figures: &Figures) -> Vec<String> {
    let measured = [
        figures.speed * 1e3,
        figures.stretch[1] * 100.0,
        figures.stretch[0] * 100.0,
        figures.tick * 1e9,
    ];
    identity(trial, figures).into_iter().chain(measured.map(figure)).collect()
}

/// What tells a trial from others, in the order of [`IDENTITY`].
fn identity(trial: &Trial, figures: &Figures) -> [String; 4] {
    let [substeps, passes] = figures.effort;
    [
        trial.seed.to_string(),
        format!("{:?}", trial.family),
        figures.particles.to_string(),
        format!("{substeps} × {passes}"),
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
