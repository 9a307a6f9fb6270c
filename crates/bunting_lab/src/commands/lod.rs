//! Agreement of the levels of detail, and the jumps between them.

use bunting_solver::instruction_set;
use serde_json::json;

use super::progress;
use crate::{
    levels::{agreement::Agreement, pops::Pop, resolution::Resolution, switches::Switch},
    output::{
        Outcome,
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure},
    },
    settings::{scheme_name, schemes},
};

/// Vertices along each side of the levels that are compared, the finest first.
const SIZES: [usize; 3] = [33, 17, 9];
/// Vertices along each side of the levels in a quick run.
const QUICK_SIZES: [usize; 3] = [17, 9, 5];
/// Number of moments at which each pair of levels is changed.
const MOMENTS: usize = 20;
/// Number of moments in a quick run.
const QUICK_MOMENTS: usize = 3;

/// Compares the levels, and changes between neighbours both ways.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let sizes = if quick { QUICK_SIZES } else { SIZES };
    let pairs = sizes.windows(2).flat_map(|pair| [(pair[0], pair[1]), (pair[1], pair[0])]);
    let pairs: Vec<(usize, usize)> = pairs.collect();
    let bar = progress(schemes().len() * (sizes.len() + 1 + 2 * pairs.len()));
    let moments = if quick { QUICK_MOMENTS } else { MOMENTS };
    let (mut levels, mut resolutions) = (Vec::new(), Vec::new());
    let (mut switches, mut pops) = (Vec::new(), Vec::new());
    for settings in schemes() {
        for n in sizes {
            levels.push(Agreement::of(n, settings, quick));
            bar.inc(1);
        }
        resolutions.extend(Resolution::of(sizes[0], settings, moments));
        bar.inc(1);
        for &(from, to) in &pairs {
            switches.push(Switch::of(from, to, settings, moments));
            bar.inc(1);
            pops.push(Pop::of(from, to, settings, moments));
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    Outcome {
        json: json!({
            "instruction_set": instruction_set(),
            "levels": levels,
            "resolutions": resolutions,
            "switches": switches,
            "pops": pops,
        }),
        tables: vec![
            level_table(&levels),
            resolution_table(&resolutions),
            switch_table(&switches),
            pop_table(&pops),
        ],
        plots: schemes().into_iter().map(|scheme| plot(&levels, scheme_name(scheme))).collect(),
    }
}

/// Plot of each figure of the levels, divided by that of the finest.
fn plot(levels: &[Agreement], scheme: &str) -> Plot {
    let of_scheme: Vec<&Agreement> = levels.iter().filter(|it| it.scheme == scheme).collect();
    let line = |name: &str, value: fn(&Agreement) -> f64| Series {
        name: name.into(),
        points: of_scheme
            .iter()
            .map(|level| (level.n as f64, value(level) / value(of_scheme[0])))
            .collect(),
        mark: Mark::Line,
    };
    Plot {
        name: format!("lod_levels_{scheme}"),
        title: format!("Agreement of the levels, {scheme}"),
        labels: ["vertices along a side".into(), "over that of the finest".into()],
        axes: Axes::Logarithmic,
        series: vec![
            line("droop", |level| level.droop_m),
            line("swing period", |level| level.swing_period_s),
            line("tip spread", |level| level.tip_spread_m),
            line("flutter frequency", |level| level.flutter_hz),
        ],
    }
}

fn level_table(levels: &[Agreement]) -> Table {
    let cells = |level: &Agreement| {
        let finest = levels.iter().find(|other| other.scheme == level.scheme).unwrap_or(level);
        vec![
            level.scheme.into(),
            level.n.to_string(),
            figure(level.droop_m),
            figure(level.swing_period_s),
            figure(level.tip_m.x),
            figure(level.tip_m.y),
            figure(level.tip_m.distance(finest.tip_m)),
            figure(level.tip_spread_m),
            figure(level.flutter_hz),
        ]
    };
    Table {
        name: "lod_levels".into(),
        title: "The same cloth at each level".into(),
        headers: vec![
            "scheme",
            "n",
            "droop m",
            "swing period s",
            "tip x m",
            "tip y m",
            "tip off the finest m",
            "tip spread m",
            "flutter Hz",
        ],
        rows: levels.iter().map(cells).collect(),
    }
}

fn resolution_table(resolutions: &[Resolution]) -> Table {
    let cells = |resolution: &Resolution| {
        vec![
            resolution.scheme.into(),
            format!("{} by {}", resolution.fine, resolution.coarse),
            figure(resolution.rms_m),
            figure(resolution.p95_m),
            figure(resolution.p95_of_cell),
        ]
    };
    Table {
        name: "lod_resolution".into(),
        title: "A flag's surface shown by the vertices of a coarser level".into(),
        headers: vec!["scheme", "levels", "RMS m", "95 % m", "95 % over the cell"],
        rows: resolutions.iter().map(cells).collect(),
    }
}

fn switch_table(switches: &[Switch]) -> Table {
    let percent = |fraction: f64| format!("{:.2} %", 100.0 * fraction);
    let cells = |switch: &Switch| {
        vec![
            switch.scheme.into(),
            format!("{} → {}", switch.from, switch.to),
            figure(switch.pop_rms_m),
            figure(switch.pop_max_m),
            figure(switch.invisible_from_m),
            percent(switch.momentum_jump),
            figure(switch.momentum_worst),
            percent(switch.kinetic_jump),
            format!("{} ×", figure(switch.energy_jump)),
            format!("{} ×", figure(switch.energy_worst)),
        ]
    };
    Table {
        name: "lod_switches".into(),
        title: "Changes of level of a flag in the wind".into(),
        headers: vec![
            "scheme",
            "levels",
            "pop RMS m",
            "pop max m",
            "< 1 px from m",
            "momentum",
            "worst, of its sum",
            "kinetic energy",
            "total energy over kinetic",
            "worst",
        ],
        rows: switches.iter().map(cells).collect(),
    }
}

fn pop_table(pops: &[Pop]) -> Table {
    let cells = |pop: &Pop| {
        vec![
            pop.scheme.into(),
            format!("{} → {}", pop.from, pop.to),
            figure(pop.distance_m),
            figure(pop.mean_px),
            figure(pop.worst_px),
            figure(pop.after_px),
            figure(pop.own_px),
            figure(pop.twin_px),
        ]
    };
    Table {
        name: "lod_pops".into(),
        title: "What is seen of a change of level, in pixels of 1080 lines over 60°".into(),
        headers: vec![
            "scheme",
            "levels",
            "from m",
            "off its motion",
            "worst",
            "in the frames after",
            "by flapping",
            "off a twin",
        ],
        rows: pops.iter().map(cells).collect(),
    }
}
