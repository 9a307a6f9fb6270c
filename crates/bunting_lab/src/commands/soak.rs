//! Scenes that run for long: whether memory, times and motion stay what they were at their start.

use std::time::Duration;

use anyhow::{Result, ensure};
use clap::Args;
use serde::Serialize;
use serde_json::json;

use super::progress;
use crate::{
    output::{
        Outcome,
        table::{Table, figure},
    },
    soak::{churn::Churn, part, part::Part, scenes},
};

/// Greatest ratios of what is greatest later to what was greatest in the first part. Buffers grow with the most that they had to
/// hold; a leak of a thousandth of the heap in a minute is found within an hour.
const HEAP: f64 = 1.05;
/// As many batches are kept as gusts have made necessary at once.
const BATCHES: f64 = 1.5;
/// Gusts of many minutes are stronger than those of the first one: motion that nothing drives grows without end.
const MOTION: f64 = 1.5;
/// Simulated time of a quick run, s.
const QUICK: f64 = 2.0;
/// Simulated time of coming and going before the bytes on the heap without cloth are first counted, s.
const FIRST_ROUND: f64 = 10.0;
/// Name of the cloths that come and go.
const CHURN: &str = "cloths that come and go";

/// How long, and what.
#[derive(Clone, Debug, Args)]
pub struct Options {
    /// Simulated time of each scene: 1h, 10h.
    #[arg(long, default_value = "1m", value_parser = humantime::parse_duration)]
    time: Duration,
    /// Run only scenes whose names contain this.
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
}

/// A run of a scene.
#[derive(Clone, Debug, Serialize)]
struct Run {
    name: &'static str,
    /// Simulated time, s.
    seconds: f64,
    first: Part,
    /// What was greatest in all later parts.
    later: Part,
    /// What became larger than it may.
    grown: Vec<&'static str>,
}

/// What is kept of cloths that are gone.
#[derive(Clone, Debug, Serialize)]
struct Kept {
    spawned: usize,
    /// Bytes on the heap without cloth, after a first round and at the end.
    before: usize,
    after: usize,
}

/// Runs the scenes, one after the other: they share the heap.
///
/// # Errors
///
/// No scene has the given name, or the time is shorter than a second.
pub fn run(options: &Options, quick: bool) -> Result<Outcome> {
    let seconds = if quick { QUICK } else { options.time.as_secs_f64() };
    ensure!(seconds >= 1.0, "a soak of {seconds} s: give at least --time 1s");
    let is_asked =
        |name: &str| options.scene.as_deref().is_none_or(|part: &str| name.contains(part));
    let asked: Vec<_> = scenes::ALL.into_iter().filter(|(name, _)| is_asked(name)).collect();
    ensure!(!asked.is_empty() || is_asked(CHURN), "no scene has {:?} in its name", options.scene);
    let bar = progress(asked.len() + 1);
    let mut runs: Vec<Run> = Vec::new();
    for (name, scene) in asked {
        bar.set_message(name);
        let (mut app, drive) = scene();
        runs.push(Run::of(name, seconds, &part::run(&mut app, seconds, drive)));
        bar.inc(1);
    }
    let mut kept = None;
    if is_asked(CHURN) {
        let (run, of_churn) = churn(seconds);
        runs.push(run);
        kept = Some(of_churn);
    }
    bar.finish_and_clear();
    let json = json!({ "runs": runs, "kept": kept });
    let tables = [table(&runs)].into_iter().chain(kept.map(|kept| kept_table(&kept))).collect();
    Ok(Outcome { json, tables, plots: Vec::new() })
}

fn churn(seconds: f64) -> (Run, Kept) {
    let (mut app, mut churn) = Churn::new();
    part::run(&mut app, FIRST_ROUND.min(seconds), |app, _| churn.act(app));
    let before = churn.heap_without_cloth(&mut app);
    let parts = part::run(&mut app, seconds, |app, _| churn.act(app));
    let after = churn.heap_without_cloth(&mut app);
    (Run::of(CHURN, seconds, &parts), Kept { spawned: churn.spawned, before, after })
}

impl Run {
    fn of(name: &'static str, seconds: f64, parts: &[Part]) -> Self {
        let (first, later) = (parts[0], Part::greatest(&parts[1..]));
        let figures = [
            ("heap", first.heap as f64, later.heap as f64, HEAP),
            ("batches", first.batches as f64, later.batches as f64, BATCHES),
            ("strain", first.strain, later.strain, MOTION),
            ("energy", first.energy, later.energy, MOTION),
            ("speed", first.speed, later.speed, MOTION),
        ];
        // What is not a number is not within its limit.
        let is_kept = |(_, first, later, ratio): &(_, f64, f64, f64)| *later <= first * ratio;
        let grown = figures.iter().filter(|figure| !is_kept(figure)).map(|figure| figure.0);
        Self { name, seconds, first, later, grown: grown.collect() }
    }
}

fn table(runs: &[Run]) -> Table {
    let row = |run: &Run| {
        let pair =
            |of: fn(&Part) -> f64| [&run.first, &run.later].map(|it| figure(of(it))).join("; ");
        let mib = |bytes: usize| bytes as f64 / f64::from(1 << 20);
        let resident = |part: &Part| part.resident.map_or(f64::NAN, mib);
        vec![
            run.name.to_owned(),
            figure(run.seconds / 60.0),
            run.later.cloths.to_string(),
            [&run.first, &run.later].map(|it| figure(mib(it.heap))).join("; "),
            [&run.first, &run.later].map(|it| figure(resident(it))).join("; "),
            [&run.first, &run.later].map(|it| it.batches.to_string()).join("; "),
            pair(|it| it.tick_us * 1e-3),
            pair(|it| it.strain * 100.0),
            pair(|it| it.energy),
            pair(|it| it.speed),
            if run.grown.is_empty() { "kept".to_owned() } else { run.grown.join(", ") },
        ]
    };
    Table {
        name: "soak".into(),
        title: "In the first minute; greatest in all later ones, of times and resident memory in the last one".into(),
        headers: vec![
            "scene",
            "min",
            "cloths",
            "heap, MiB",
            "resident, MiB",
            "batches",
            "ms a tick",
            "strain, %",
            "J/kg",
            "m/s",
            "has grown",
        ],
        rows: runs.iter().map(row).collect(),
    }
}

fn kept_table(kept: &Kept) -> Table {
    Table {
        name: "soak_kept".into(),
        title: "Bytes on the heap without cloth, eleven seconds after the last one is gone".into(),
        headers: vec!["cloths spawned", "after a first round", "at the end"],
        rows: vec![vec![kept.spawned.to_string(), kept.before.to_string(), kept.after.to_string()]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(heap: usize, speed: f64) -> Part {
        Part { heap, speed, ..Part::default() }
    }

    #[test]
    fn what_grows_is_named() {
        let grown = |parts: &[Part]| Run::of("", 60.0, parts).grown;
        assert!(grown(&[part(1000, 1.0), part(1040, 1.4), part(900, 0.1)]).is_empty());
        assert_eq!(grown(&[part(1000, 1.0), part(1060, 1.0), part(900, 1.6)]), ["heap", "speed"]);
        assert_eq!(grown(&[part(1, 1.0), part(1, f64::NAN), part(1, 1.0)]), ["speed"]);
    }
}
