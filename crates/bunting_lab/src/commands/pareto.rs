//! Speed against error: every method on the standard scenes.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use bunting_solver::instruction_set;
use clap::Args;
use serde_json::json;

use super::{ablation, progress};
use crate::{
    comparison::{
        measurement::{contenders, measure},
        meshes,
        row::{COMPARED, LeftOut, Row},
        speed_error,
    },
    output::{
        Outcome,
        plot::Plot,
        table::{Table, figure, figure_or_dash},
    },
    parallel,
    reference::Reference,
    scenes::{Measure, Scene},
};

/// Time after which a method that would take longer on a scene is left out, s.
const TIME_LIMIT: f64 = 15.0;
/// Largest n of the flag: its reference takes minutes beyond this size.
const LARGEST_FLAG: usize = 33;
/// Vertices along each side of the cloth whose parts are left out one by one: of a full and of a quick run.
const ABLATED: [usize; 2] = [33, 9];

/// Scenes and sizes to compare.
#[derive(Clone, Debug, Args)]
pub struct Selection {
    /// Scenes, of hang_top, hang_side, hang_corners, swing and flag.
    #[arg(
        long,
        value_delimiter = ',',
        value_parser = ["hang_top", "hang_side", "hang_corners", "swing", "flag"],
        default_values = ["hang_top", "hang_side", "hang_corners", "swing", "flag"]
    )]
    scenes: Vec<String>,
    /// Vertices along each side.
    #[arg(long, value_delimiter = ',', default_values_t = [9, 17, 33, 65], value_parser = parse_size)]
    sizes: Vec<usize>,
    /// Leave out a method that would take longer than this on a scene, s.
    #[arg(long, default_value_t = TIME_LIMIT, value_parser = parse_time_limit)]
    time_limit: f64,
    /// Also draw error over time of the position-based methods, on the last selected scene, as SVG.
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    /// Instead compare the grid with meshes of as many particles, on the scene swing; `--figure` then draws these.
    #[arg(long)]
    meshes: bool,
}

impl Selection {
    /// Selection of these scenes at these sizes.
    #[must_use]
    pub fn new(scenes: &[&str], sizes: Vec<usize>, time_limit: f64) -> Self {
        let scenes = scenes.iter().map(|&name| name.to_owned()).collect();
        Self { scenes, sizes, time_limit, figure: None, meshes: false }
    }
}

fn parse_time_limit(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 => Ok(seconds),
        _ => Err("the limit is a number of seconds above zero".into()),
    }
}

fn parse_size(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if (2..=129).contains(&n) => Ok(n),
        _ => Err("a size is a whole number from 2 to 129".into()),
    }
}

/// Runs every method on the selected scenes.
///
/// # Errors
///
/// The requested figure cannot be drawn or written.
pub fn run(selection: &Selection, quick: bool) -> Result<Outcome> {
    if selection.meshes {
        return run_meshes(selection.figure.as_deref());
    }
    let contenders = contenders(quick);
    let scenes = selected(selection, quick);
    let bar = progress(scenes.len() * contenders.len());
    let mut outcome = Outcome { json: json!(null), tables: Vec::new(), plots: Vec::new() };
    let (mut all, mut left_out, mut references) = (Vec::new(), Vec::new(), Vec::new());
    bar.set_message("references");
    // All references are computed before any time is taken.
    let converged = parallel::map(&scenes, Reference::of);
    for (scene, reference) in scenes.iter().zip(&converged) {
        let mut rows = Vec::new();
        for contender in &contenders {
            bar.set_message(format!("{} {} {}", scene.name, scene.columns, contender.method));
            match measure(scene, contender, selection.time_limit) {
                Some((seen, time)) => {
                    rows.push(Row::new(scene, contender, &seen, &time, reference));
                }
                None => left_out.push(LeftOut::new(scene, contender)),
            }
            bar.inc(1);
        }
        outcome.tables.push(table(scene, &rows, reference));
        outcome.plots.extend(speed_error::plot(scene, &rows, &contenders));
        references.push(json!({
            "scene": scene.name,
            "n": scene.columns,
            "steps": reference.steps,
            "residual_n": reference.residual,
            "step_error_m": reference.step_errors[COMPARED],
            "mean_stretch": reference.observation.strain.mean,
            "max_stretch": reference.observation.strain.max,
        }));
        all.push(rows);
    }
    if let (Some(path), Some((scene, rows))) =
        (&selection.figure, scenes.iter().zip(&all).next_back())
    {
        write_figure(path, &speed_error::figure(scene, rows))?;
    }
    bar.set_message("ablation");
    let n = ABLATED[usize::from(quick)];
    let parts = ablation::rows(n);
    outcome.tables.push(ablation::table(n, &parts));
    outcome.tables.push(left_out_table(&left_out));
    bar.finish_and_clear();
    outcome.json = json!({
        "instruction_set": instruction_set(),
        "rows": all.concat(),
        "left_out": left_out,
        "references": references,
        "ablation": parts,
    });
    Ok(outcome)
}

/// Runs each method on the grid and on meshes of as many particles.
fn run_meshes(path: Option<&Path>) -> Result<Outcome> {
    let rows = meshes::rows();
    let plot = meshes::plot(&rows);
    if let Some(path) = path {
        write_figure(path, &plot)?;
    }
    Ok(Outcome {
        json: json!({ "instruction_set": instruction_set(), "rows": rows }),
        tables: vec![meshes::table(&rows)],
        plots: vec![plot],
    })
}

fn write_figure(path: &Path, plot: &Plot) -> Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
    }
    fs::write(path, plot.svg()?).with_context(|| format!("cannot write {}", path.display()))
}

fn selected(selection: &Selection, quick: bool) -> Vec<Scene> {
    let sizes: Vec<usize> = if quick { vec![9] } else { selection.sizes.clone() };
    sizes
        .into_iter()
        .flat_map(Scene::standard)
        .filter(|scene| selection.scenes.iter().any(|name| name == scene.name))
        .filter(|scene| {
            scene.measure != Measure::Statistics || (!quick && scene.columns <= LARGEST_FLAG)
        })
        .collect()
}

fn table(scene: &Scene, rows: &[Row], reference: &Reference) -> Table {
    let strain = reference.observation.strain;
    let residual =
        reference.residual.map_or_else(String::new, |force| format!(", residual {force:.0e} N"));
    Table {
        name: format!("pareto_{}_{}", scene.name, scene.columns),
        title: format!(
            "{} {n} × {n}; reference: strain mean {} max {}, {} steps a tick{residual}",
            scene.name,
            figure(strain.mean),
            figure(strain.max),
            reference.steps,
            n = scene.columns,
        ),
        headers: vec![
            "method",
            "substeps",
            "passes",
            "lanes",
            "µs/tick",
            "RMS error m",
            "mean strain",
            "max strain",
            "strain error",
            "tip error m",
            "stable",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}

fn cells(row: &Row) -> Vec<String> {
    vec![
        row.method.clone(),
        row.substeps.to_string(),
        row.passes.to_string(),
        row.lanes.to_string(),
        figure(row.us_per_cloth_tick),
        figure_or_dash(row.rms_error_m),
        figure(row.mean_stretch),
        figure(row.max_stretch),
        figure(row.strain_error),
        figure(row.tip_error_m),
        if row.stable { "yes" } else { "no" }.into(),
    ]
}

fn left_out_table(left_out: &[LeftOut]) -> Table {
    Table {
        name: "pareto_left_out".into(),
        title: "Left out: not made for the scene, or too long a run".into(),
        headers: vec!["scene", "n", "method", "substeps", "passes"],
        rows: left_out
            .iter()
            .map(|it| {
                let settings = [it.n, it.substeps, it.passes].map(|number| number.to_string());
                let [n, substeps, passes] = settings;
                vec![it.scene.into(), n, it.method.clone(), substeps, passes]
            })
            .collect(),
    }
}
