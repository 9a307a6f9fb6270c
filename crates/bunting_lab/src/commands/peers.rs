//! This project and other engines, in one run on the same scenes.

use bunting_solver::instruction_set;
use serde_json::json;

use super::progress;
use crate::{
    output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure, figure_or_dash},
    },
    peers::{
        engine::Engine,
        measurement::{self, Row, Shock},
    },
    scenes::Scene,
};

/// Vertices along each side.
const SIZE: usize = 33;
/// Vertices along each side in a quick run.
const QUICK_SIZE: usize = 9;

/// Hangs a cloth by its top, its side and its corners in every engine, and disturbs it.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let n = if quick { QUICK_SIZE } else { SIZE };
    let scenes = [Scene::hang_top(n), Scene::hang_side(n), Scene::hang_corners(n)];
    let engines = Engine::all();
    let bar = progress(engines.len() * (scenes.len() + 1));
    let (mut rows, mut shocks) = (Vec::new(), Vec::new());
    for scene in &scenes {
        for engine in &engines {
            bar.set_message(format!("{} {}", scene.name, engine.name));
            rows.push(measurement::hang(engine, scene));
            bar.inc(1);
        }
    }
    for engine in engines.iter().filter(|engine| engine.lanes == 1) {
        bar.set_message(format!("shocks {}", engine.name));
        shocks.extend(measurement::shocks(engine, &scenes[1]));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Outcome {
        json: json!({
            "instruction_set": instruction_set(),
            "rows": rows,
            "shocks": shocks,
        }),
        tables: vec![row_table(&rows, n), shock_table(&shocks, n), constraint_table(&engines)],
        plots: scenes.iter().filter_map(|scene| plot(scene, &rows)).collect(),
    }
}

/// Largest strain over time of every engine on a scene.
fn plot(scene: &Scene, rows: &[Row]) -> Option<Plot> {
    let mut series: Vec<Series> = Vec::new();
    for row in rows.iter().filter(|row| row.scene == scene.name) {
        let name = match row.lanes {
            1 => row.engine.to_owned(),
            lanes => format!("{}, of {lanes}", row.engine),
        };
        let Some(strain) = row.max_stretch.filter(|strain| *strain > 0.0) else { continue };
        let point = (row.ms_per_tick, strain);
        match series.iter_mut().find(|known| known.name == name) {
            Some(known) => known.points.push(point),
            None => series.push(Series { name, points: vec![point], mark: Mark::Dots }),
        }
    }
    (!series.is_empty()).then(|| Plot {
        name: format!("peers_{}", scene.name),
        title: format!("{} {n} × {n}", scene.name, n = scene.columns),
        labels: ["time of one cloth's tick, ms".into(), "largest strain at rest".into()],
        axes: Axes::Logarithmic,
        series,
    })
}

fn row_table(rows: &[Row], n: usize) -> Table {
    let cells = |row: &Row| {
        vec![
            row.scene.into(),
            row.engine.into(),
            row.substeps.to_string(),
            row.lanes.to_string(),
            figure(row.ms_per_tick),
            figure(row.ms_min),
            figure_or_dash(row.mean_stretch),
            figure_or_dash(row.max_stretch),
            figure_or_dash(row.final_speed),
        ]
    };
    Table {
        name: "peers".into(),
        title: format!("At rest after 6 s, {n} × {n}, no wind, one core, times of one cloth"),
        headers: vec![
            "scene",
            "engine",
            "substeps",
            "lanes",
            "ms/tick",
            "ms min",
            "mean strain",
            "max strain",
            "RMS speed m/s",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}

fn constraint_table(engines: &[Engine]) -> Table {
    let alone = engines.iter().filter(|engine| engine.lanes == 1);
    let cells = |engine: &Engine| {
        vec![engine.name.into(), engine.substeps.to_string(), engine.constraints.into()]
    };
    Table {
        name: "peers_constraints".into(),
        title: "Same particles, same masses, the same links; constraints as near as can be".into(),
        headers: vec!["engine", "substeps", "constraints"],
        rows: alone.map(cells).collect(),
    }
}

fn shock_table(shocks: &[Shock], n: usize) -> Table {
    let cells = |shock: &Shock| {
        vec![
            shock.shock.into(),
            shock.engine.into(),
            shock.substeps.to_string(),
            if shock.finite { "yes" } else { "no" }.into(),
            figure(shock.ms),
            figure_or_dash(shock.worst_stretch),
            shock.recovery_s.map_or_else(|| "not within 5 s".into(), figure),
        ]
    };
    Table {
        name: "peers_shocks".into(),
        title: format!("Shocks of a cloth hung by its side, {n} × {n}"),
        headers: vec![
            "shock",
            "engine",
            "substeps",
            "finite",
            "ms of that tick",
            "worst strain",
            "recovered after s",
        ],
        rows: shocks.iter().map(cells).collect(),
    }
}
