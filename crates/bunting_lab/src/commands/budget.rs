//! How much cloth fits in a budget of time.

use bevy_bunting::ClothSystems;
use bunting_solver::instruction_set;
use serde_json::json;

use super::progress;
use crate::{
    budget::{
        Effort, LEVELS,
        kernels::{self, Kernels},
        phases::{self, PHASES, Phase},
        scheme_name, schemes,
        sheets::{self, Sheet},
        thousand::{self, Thousand},
    },
    output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure},
    },
};

/// Measures sheets, phases, kernels and the thousand flags.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let effort = Effort::of(quick);
    let bar = progress(sheets::count(&effort) + 3);
    bar.set_message("sheets");
    let sheets = sheets::measure(&effort, || bar.inc(1));
    bar.set_message("phases");
    let phases = phases::measure(&effort);
    bar.inc(1);
    bar.set_message("kernels");
    let kernels = kernels::measure(&effort);
    bar.inc(1);
    bar.set_message("a thousand flags");
    let thousand = thousand::measure(quick);
    bar.finish_and_clear();
    Outcome {
        json: json!({
            "instruction_set": instruction_set(),
            "sheets": sheets,
            "phases": phases,
            "kernels": kernels,
            "thousand": thousand,
        }),
        tables: vec![
            thousand_table(&thousand),
            sheet_table(&sheets),
            phase_table(&phases),
            kernel_table(&kernels),
        ],
        plots: schemes()
            .into_iter()
            .map(scheme_name)
            .flat_map(|scheme| [sheet_plot(&sheets, scheme), phase_plot(&phases, scheme)])
            .collect(),
    }
}

fn sheet_table(sheets: &[Sheet]) -> Table {
    let cells = |sheet: &Sheet| {
        vec![
            sheet.scheme.into(),
            sheet.n.to_string(),
            sheet.cloths.to_string(),
            sheet.cores.to_string(),
            figure(sheet.ms_per_tick),
            figure(sheet.ms_min),
            figure(sheet.ms_per_tick * 1e3 / sheet.cloths as f64),
            figure(sheet.over_one_core),
        ]
    };
    Table {
        name: "budget_sheets".into(),
        title: format!("Flags in the wind, {}", instruction_set()),
        headers: vec![
            "scheme",
            "n",
            "cloths",
            "cores",
            "ms/tick",
            "ms min",
            "µs/cloth",
            "over one core",
        ],
        rows: sheets.iter().map(cells).collect(),
    }
}

fn phase_table(phases: &[Phase]) -> Table {
    let cells = |phase: &Phase| {
        vec![
            phase.scheme.into(),
            phase.n.to_string(),
            phase.phase.into(),
            format!("{:.1} %", 100.0 * phase.share),
            figure(phase.us),
        ]
    };
    Table {
        name: "budget_phases".into(),
        title: "Share of each phase in the tick of a full batch".into(),
        headers: vec!["scheme", "n", "phase", "share", "µs/tick"],
        rows: phases.iter().map(cells).collect(),
    }
}

fn kernel_table(kernels: &Kernels) -> Table {
    Table {
        name: "budget_kernels".into(),
        title: "Kernels, of a full batch of 33 × 33".into(),
        headers: vec!["kernel", "ns per cloth"],
        rows: vec![
            vec!["link of the yarns".into(), figure(kernels.ns_per_constraint)],
            vec![
                "link or hinge of Gauss–Seidel".into(),
                figure(kernels.ns_per_constraint_gauss_seidel),
            ],
            vec!["triangle in the wind".into(), figure(kernels.ns_per_wind_triangle)],
        ],
    }
}

fn thousand_table(thousand: &Thousand) -> Table {
    let list = |values: &[f64]| {
        let levels = values.iter().zip(LEVELS);
        levels.map(|(flags, n)| format!("{flags:.0} of {n}²")).collect::<Vec<_>>().join(", ")
    };
    let steps = thousand.steps.iter().zip(LEVELS);
    let steps = steps.map(|((substeps, passes), n)| format!("{n}²: {substeps} × {passes}"));
    let sets = ClothSystems::ORDER.iter().zip(&thousand.ms_per_set);
    let sets = sets.map(|(set, ms)| format!("{set:?} {}", figure(*ms)));
    let [median, high] = ["median", "95 %"];
    let rows = [
        (format!("update of the app, ms, {median}"), figure(thousand.ms_median)),
        (format!("update of the app, ms, {high}"), figure(thousand.ms_p95)),
        ("worst second, ms, mean".into(), figure(thousand.ms_worst_second)),
        (format!("worst second, ms, {high}"), figure(thousand.ms_p95_worst_second)),
        (format!("tick of the plugin, ms, {median}"), figure(thousand.ms_tick_median)),
        (format!("tick of the plugin, ms, {high}"), figure(thousand.ms_tick_p95)),
        ("expected of a tick, ms, mean".into(), figure(thousand.ms_expected)),
        (format!("governor, ms, {median}"), figure(thousand.ms_choice_median)),
        (format!("governor, ms, {high}"), figure(thousand.ms_choice_p95)),
        ("sets, ms, median".into(), sets.collect::<Vec<_>>().join(", ")),
        ("simulated, mean".into(), list(&thousand.per_level)),
        ("simulated, least".into(), list(&thousand.per_level_least)),
        ("in view, least".into(), figure(thousand.in_view_least)),
        ("asleep, mean".into(), figure(thousand.asleep)),
        ("held back, mean".into(), figure(thousand.held_back)),
        ("changes a tick".into(), figure(thousand.changes_per_tick)),
        ("substeps × passes".into(), steps.collect::<Vec<_>>().join(", ")),
    ];
    Table {
        name: "budget_thousand".into(),
        title: "1000 flags around a moving camera, through the plugin, one core".into(),
        headers: vec!["", ""],
        rows: rows.into_iter().map(|(name, value)| vec![name, value]).collect(),
    }
}

/// Figure 6.2: one line a level and number of cores.
fn sheet_plot(sheets: &[Sheet], scheme: &str) -> Plot {
    let mut series: Vec<Series> = Vec::new();
    for sheet in sheets.iter().filter(|sheet| sheet.scheme == scheme) {
        let name = format!("{n} × {n}, {} cores", sheet.cores, n = sheet.n);
        let point = (sheet.cloths as f64, sheet.ms_per_tick);
        match series.iter_mut().find(|series| series.name == name) {
            Some(found) => found.points.push(point),
            None => series.push(Series { name, points: vec![point], mark: Mark::Line }),
        }
    }
    Plot {
        name: format!("budget_sheets_{scheme}"),
        title: format!("Time of a tick, wind on, {scheme} (thesis, fig. 6.2)"),
        labels: ["flags".into(), "ms".into()],
        axes: Axes::Logarithmic,
        series,
    }
}

/// Figure B.1: a stacked bar a level.
fn phase_plot(phases: &[Phase], scheme: &str) -> Plot {
    let up_to = |n: u32, last: usize| {
        let below = PHASES[..=last].iter();
        below
            .filter_map(|name| {
                phases.iter().find(|p| p.scheme == scheme && p.n == n && p.phase == *name)
            })
            .map(|phase| phase.share)
            .sum::<f64>()
    };
    let series = (0..PHASES.len()).rev().map(|last| Series {
        name: PHASES[last].into(),
        points: (0..).zip(LEVELS).map(|(level, n)| (f64::from(level), up_to(n, last))).collect(),
        mark: Mark::Bars,
    });
    Plot {
        name: format!("budget_phases_{scheme}"),
        title: format!("Share of each phase, {scheme} (thesis, fig. B.1)"),
        labels: ["level".into(), "share of the tick".into()],
        axes: Axes::Named(LEVELS.map(|n| format!("{n} × {n}")).to_vec()),
        series: series.collect(),
    }
}
