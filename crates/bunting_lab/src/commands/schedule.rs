//! Cost of the plugin's schedule over plain calls of the solver.

use bevy_app::App;
use bevy_bunting::{ClothTimings, LodSet};
use bunting_solver::{StepSettings, instruction_set};
use glam::Vec3;
use serde::Serialize;
use serde_json::json;

use super::progress;
use crate::{
    fleet::Fleet,
    game,
    output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure},
    },
    scenes::Scene,
    settings::{LEVELS, scheme_name, schemes},
    timing::Timing,
};

/// Flags: a full batch of eight lanes.
const FLAGS: usize = 8;
/// Ticks before time is taken.
const WARM_UP: usize = 30;
/// Ticks that are timed.
const TICKS: usize = 600;
/// Ticks that are timed in a quick run.
const QUICK_TICKS: usize = 60;

/// One level with one scheme.
#[derive(Clone, Debug, Serialize)]
struct Row {
    scheme: &'static str,
    substeps: u32,
    n: u32,
    cloths: usize,
    /// Median time of an update of the app, µs.
    us_app: f64,
    /// Median time of the app's cloth tick, by the plugin's own clock, µs.
    us_cloth_tick: f64,
    /// Median time of the same tick by plain calls, µs.
    us_plain: f64,
    /// `us_app` over `us_plain`.
    ratio: f64,
}

/// Steps the same flags alternately in an app and by plain calls.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let bar = progress(schemes().len() * LEVELS.len());
    let mut rows = Vec::new();
    for settings in schemes() {
        for n in LEVELS {
            rows.push(compare(n, settings, if quick { QUICK_TICKS } else { TICKS }));
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    Outcome {
        json: json!({ "instruction_set": instruction_set(), "rows": rows }),
        tables: vec![table(&rows)],
        plots: vec![plot(&rows)],
    }
}

fn plot(rows: &[Row]) -> Plot {
    let line = |scheme: &str, what: &str, time: fn(&Row) -> f64| {
        let of_scheme = rows.iter().filter(|row| row.scheme == scheme);
        let points = of_scheme.map(|row| (f64::from(row.n), time(row))).collect();
        Series { name: format!("{scheme}, {what}"), points, mark: Mark::Line }
    };
    let of_scheme = |scheme| {
        [line(scheme, "app", |row| row.us_app), line(scheme, "plain calls", |row| row.us_plain)]
    };
    Plot {
        name: "schedule".into(),
        title: format!("{FLAGS} flags in an app and by plain calls"),
        labels: ["vertices along a side".into(), "µs a tick".into()],
        axes: Axes::Logarithmic,
        series: schemes().map(scheme_name).into_iter().flat_map(of_scheme).collect(),
    }
}

fn compare(n: u32, settings: StepSettings, ticks: usize) -> Row {
    let mut app = flags(n, settings);
    let mut plain = Fleet::new(Scene::flag(n as usize), FLAGS, settings);
    plain.advance(WARM_UP);
    (0..WARM_UP).for_each(|_| app.update());
    let mut times: [Timing; 3] = Default::default();
    for _ in 0..ticks {
        times[0].time(|| app.update());
        times[1].push(app.world().resource::<ClothTimings>().total().as_secs_f64() * 1e6);
        times[2].time(|| plain.advance(1));
    }
    let [us_app, us_cloth_tick, us_plain] = times.map(|time| time.median());
    Row {
        scheme: scheme_name(settings),
        substeps: settings.substeps,
        n,
        cloths: FLAGS,
        us_app,
        us_cloth_tick,
        us_plain,
        ratio: us_app / us_plain,
    }
}

fn flags(n: u32, settings: StepSettings) -> App {
    let mut app = game::app_in_wind([settings]);
    for flag in 0..FLAGS {
        game::spawn_flag(&mut app, n, Vec3::X * flag as f32, LodSet::default());
    }
    app
}

fn table(rows: &[Row]) -> Table {
    let cells = |row: &Row| {
        vec![
            row.scheme.into(),
            row.substeps.to_string(),
            row.n.to_string(),
            figure(row.us_app),
            figure(row.us_cloth_tick),
            figure(row.us_plain),
            figure(row.us_app - row.us_plain),
            figure(row.ratio),
        ]
    };
    Table {
        name: "schedule".into(),
        title: format!("{FLAGS} flags in an app and by plain calls, one core, µs a tick"),
        headers: vec![
            "scheme",
            "substeps",
            "n",
            "app update",
            "its cloth tick",
            "plain calls",
            "cost",
            "ratio",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}
