//! The report of all measurements: an HTML page, and a committed Markdown document with its plots.

use std::{
    fs,
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result};
use clap::Args;
use serde_json::{Map, Value};

use super::{
    budget, families::Selection, lod, memory, oracles, pareto, schedule, sharing, stability,
};
use crate::{
    output::{Outcome, table::Table},
    report::{machine::Machine, markdown, page, section::Section},
};

/// Destination of the report.
#[derive(Clone, Debug, Args)]
pub struct Options {
    /// Folder of `measurements.md` and of its plots: the repository's `docs`, but none in a quick run.
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
}

/// Default folder of the page.
const FOLDER: &str = "out/report";
/// The repository's documents.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
/// Vertices along each side for which methods are compared: more sizes would take hours.
const SIZES: [usize; 1] = [33];
/// Scenes on which methods are compared.
const SCENES: [&str; 5] = ["swing", "hang_top", "hang_side", "hang_corners", "flag"];
/// Scenes on which methods are compared in a quick run.
const QUICK_SCENES: [&str; 2] = ["swing", "hang_corners"];
/// Time after which a method that would take longer on a scene is left out, s.
const TIME_LIMIT: f64 = 2.0;

/// Command that runs the lab with the features that it is built with.
const PROGRAM: &str = if cfg!(feature = "peers") {
    "cargo run --release -p bunting_lab --features peers --"
} else {
    "cargo run --release -p bunting_lab --"
};

/// Runs every command, and writes `index.html` and `measurements.md`. A command that fails or panics is named
/// in both, and the others still run.
///
/// # Errors
///
/// When a file cannot be written.
pub fn run(options: &Options, quick: bool, folder: Option<&Path>) -> Result<Outcome> {
    let machine = Machine::here();
    let sections = measure(quick);
    let folder = folder.map_or_else(|| PathBuf::from(FOLDER), Path::to_path_buf);
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let path = folder.join("index.html");
    fs::write(&path, page::render(&sections, &machine, quick)?)
        .with_context(|| format!("cannot write {}", path.display()))?;
    eprintln!("{}", path.display());
    let docs = options.docs.clone().or_else(|| (!quick).then(|| PathBuf::from(DOCS)));
    if let Some(docs) = docs {
        markdown::write(&docs, &sections, &machine, quick)?;
        eprintln!("{}", docs.join("measurements.md").display());
    }
    let table = findings_table(&sections);
    let json: Map<String, Value> = sections
        .into_iter()
        .map(|section| {
            let json = section.outcome.map_or_else(Value::String, |outcome| outcome.json);
            (section.command.to_owned(), json)
        })
        .collect();
    Ok(Outcome { json: json.into(), tables: vec![table], plots: Vec::new() })
}

fn measure(quick: bool) -> Vec<Section> {
    let scenes = if quick { &QUICK_SCENES[..] } else { &SCENES };
    let selection = pareto::Selection::new(scenes, SIZES.to_vec(), TIME_LIMIT);
    let pareto = || pareto::run(&selection, quick);
    let pareto_options =
        format!("--scenes {} --sizes {} --time-limit {TIME_LIMIT}", scenes.join(","), SIZES[0]);
    let mut sections = vec![
        section("budget", "", quick, "time of flags and where it goes, beside the thesis", || {
            Ok(budget::run(quick))
        }),
        section("pareto", &pareto_options, quick, "error over time of every method", pareto),
        section("stability", "", quick, "the hard cases, each with its worst figure", || {
            stability::run(&Selection::default(), quick)
        }),
        section("oracles", "", false, "closed forms against what the cloth does", || {
            oracles::run(&Selection::default())
        }),
        section("lod", "", quick, "how alike levels are, and what changing them does", || {
            Ok(lod::run(quick))
        }),
        section("memory", "", false, "bytes of a chain of levels and of batches", || {
            Ok(memory::run())
        }),
        section("schedule", "", quick, "the plugin's cost over plain calls of the solver", || {
            Ok(schedule::run(quick))
        }),
        section(
            "sharing",
            "",
            quick,
            "flags that need different substeps, in shared batches",
            || Ok(sharing::run(quick)),
        ),
    ];
    sections.extend(peers(quick));
    sections
}

#[cfg(feature = "peers")]
fn peers(quick: bool) -> Option<Section> {
    let run = || Ok(super::peers::run(quick));
    Some(section("peers", "", quick, "other engines on the same scenes", run))
}

#[cfg(not(feature = "peers"))]
fn peers(_quick: bool) -> Option<Section> {
    None
}

/// Runs a command, and stores its error if it fails.
fn section(
    command: &'static str,
    options: &str,
    quick: bool,
    measures: &'static str,
    run: impl FnOnce() -> Result<Outcome>,
) -> Section {
    let start = Instant::now();
    let outcome = match panic::catch_unwind(AssertUnwindSafe(run)) {
        Ok(outcome) => outcome.map_err(|error| format!("{error:#}")),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            Err(format!("panicked: {}", text.unwrap_or("without a message")))
        }
    };
    let quick = if quick { "--quick" } else { "" };
    let words = [PROGRAM, command, options, quick];
    let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
    let took = start.elapsed();
    eprintln!("{command}: {:.1} s", took.as_secs_f64());
    Section { command, command_line: words.join(" "), measures, outcome, took }
}

fn findings_table(sections: &[Section]) -> Table {
    let rows = sections.iter().flat_map(|section| {
        section.findings().into_iter().map(|finding| {
            let verdict = if finding.good { "good" } else { "not good" };
            vec![section.command.to_owned(), verdict.to_owned(), finding.text]
        })
    });
    Table {
        name: "findings".into(),
        title: "What the figures say".into(),
        headers: vec!["command", "verdict", "finding"],
        rows: rows.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_that_fails_or_panics_is_named() {
        let failed = section("a", "--b c", true, "", || anyhow::bail!("no way"));
        assert_eq!(failed.command_line, format!("{PROGRAM} a --b c --quick"));
        assert_eq!(failed.outcome.unwrap_err(), "no way");
        let panicked = section("a", "", false, "", || panic!("at once"));
        assert_eq!(panicked.command_line, format!("{PROGRAM} a"));
        assert_eq!(panicked.outcome.unwrap_err(), "panicked: at once");
    }
}
