//! Everything that the lab measures, as one page.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result};
use serde_json::{Map, Value};

use super::{budget, lod, oracles, pareto, schedule, stability};
use crate::{
    output::{Outcome, table::Table},
    report::{Section, findings, machine::Machine, page},
};

/// Folder where none is given.
const FOLDER: &str = "out/report";
/// Vertices along each side for which methods are compared: more would take hours.
const SIZES: [usize; 1] = [33];
/// Scenes on which methods are compared.
const SCENES: [&str; 5] = ["swing", "hang_top", "hang_side", "hang_corners", "flag"];
/// The same where it is to be quick.
const QUICK_SCENES: [&str; 2] = ["swing", "hang_corners"];
/// Time after which a method that would take longer on a scene is left out, s.
const PATIENCE: f64 = 5.0;

/// Runs every command and writes `index.html`.
///
/// # Errors
///
/// When the page cannot be drawn or written.
pub fn run(quick: bool, folder: Option<&Path>) -> Result<Outcome> {
    let sections = measure(quick)?;
    let folder = folder.map_or_else(|| PathBuf::from(FOLDER), Path::to_path_buf);
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let path = folder.join("index.html");
    fs::write(&path, page::render(&sections, &Machine::here(), quick)?)
        .with_context(|| format!("cannot write {}", path.display()))?;
    eprintln!("{}", path.display());
    let table = findings_table(&sections);
    let json: Map<String, Value> = sections
        .into_iter()
        .map(|section| (section.command.to_owned(), section.outcome.json))
        .collect();
    Ok(Outcome { json: json.into(), tables: vec![table], plots: Vec::new() })
}

fn measure(quick: bool) -> Result<Vec<Section>> {
    let mut sections = Vec::new();
    let mut add = |command, measures, run: &dyn Fn() -> Result<Outcome>| {
        let start = Instant::now();
        let outcome = run()?;
        sections.push(Section { command, measures, outcome, took: start.elapsed() });
        anyhow::Ok(())
    };
    let scenes = if quick { &QUICK_SCENES[..] } else { &SCENES };
    let selection = pareto::Selection::new(scenes, SIZES.to_vec(), PATIENCE);
    add("oracles", "closed forms of mathematics against what the cloth does", &|| {
        Ok(oracles::run())
    })?;
    add("stability", "the hard cases, each with its worst figure", &|| Ok(stability::run(quick)))?;
    add("pareto", "error over time of every method against a converged reference", &|| {
        pareto::run(&selection, quick)
    })?;
    add("budget", "how many flags fit in a budget of time, and where the time goes", &|| {
        Ok(budget::run(quick))
    })?;
    add("lod", "whether the levels of detail behave alike, and what changing them does", &|| {
        Ok(lod::run(quick))
    })?;
    add("schedule", "what the plugin costs over plain calls of the solver", &|| {
        Ok(schedule::run(quick))
    })?;
    #[cfg(feature = "peers")]
    add("peers", "other engines on the same scenes", &|| Ok(super::peers::run(quick)))?;
    Ok(sections)
}

fn findings_table(sections: &[Section]) -> Table {
    let rows = sections.iter().flat_map(|section| {
        let found = findings::of(section.command, &section.outcome.json);
        found.into_iter().map(|finding| {
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
