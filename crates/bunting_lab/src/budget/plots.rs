//! Plots of the budget's figures, drawn like the thesis's own.

use super::{
    distance::AtDistance,
    many_flags::ManyFlags,
    parts::{PARTS, Part},
    thesis,
};
use crate::{
    output::plot::{Axes, Mark, Plot, Series},
    settings::LEVELS,
};

/// Figure 6.2: one line for each level and number of cores.
#[must_use]
pub fn many_flags_plot(many_flags: &[ManyFlags], scheme: &str) -> Plot {
    let mut series: Vec<Series> = Vec::new();
    for it in many_flags.iter().filter(|it| it.scheme == scheme) {
        let cores = if it.cores == 1 { "one core".into() } else { format!("{} cores", it.cores) };
        let name = format!("{n} × {n}, {cores}", n = it.n);
        let point = (it.cloths as f64, it.ms_per_tick);
        match series.iter_mut().find(|series| series.name == name) {
            Some(found) => found.points.push(point),
            None => series.push(Series { name, points: vec![point], mark: Mark::Line }),
        }
    }
    let flags = thesis::FLAGS as f64;
    for (name, ms) in
        [("thesis, finest", thesis::FINEST_MS), ("thesis, coarsest", thesis::COARSEST_MS)]
    {
        series.push(Series { name: name.into(), points: vec![(flags, ms)], mark: Mark::Dots });
    }
    Plot {
        name: format!("budget_many_flags_{scheme}"),
        title: format!("Time of a tick, wind on, {scheme} (thesis, fig. 6.2)"),
        labels: ["flags".into(), "ms".into()],
        axes: Axes::Logarithmic,
        series,
    }
}

/// Figure 6.2 over the distance: one line, between the thesis's times of its finest and coarsest level.
#[must_use]
pub fn distance_plot(distances: &[AtDistance]) -> Plot {
    let points: Vec<(f64, f64)> =
        distances.iter().map(|it| (it.distance_m, it.ms_per_tick)).collect();
    let guide = |level: &str, ms: f64| Series {
        name: format!("thesis, {level}: {ms} ms"),
        points: points.iter().map(|&(distance, _)| (distance, ms)).collect(),
        mark: Mark::Guide,
    };
    let guides = [guide("finest", thesis::FINEST_MS), guide("coarsest", thesis::COARSEST_MS)];
    Plot {
        name: "budget_distance".into(),
        title: "Eight flags by their distance (thesis, fig. 6.2)".into(),
        labels: ["distance from the viewer, m".into(), "ms a tick".into()],
        axes: Axes::Logarithmic,
        series: [Series { name: "plugin, one core".into(), points, mark: Mark::Line }]
            .into_iter()
            .chain(guides)
            .collect(),
    }
}

/// Figure B.1: a stacked bar for each level. Parts below the noise count as zero.
#[must_use]
pub fn part_plot(parts: &[Part]) -> Plot {
    let of_level = |n: u32| parts.iter().filter(move |it| it.n == n && PARTS.contains(&it.part));
    let up_to = |n: u32, last: usize| {
        let whole: f64 = of_level(n).map(|part| part.us.max(0.0)).sum();
        let below = of_level(n).filter(|part| PARTS[..=last].contains(&part.part));
        below.map(|part| part.us.max(0.0)).sum::<f64>() / whole
    };
    let series = (0..PARTS.len()).rev().map(|last| Series {
        name: PARTS[last].into(),
        points: (0..).zip(LEVELS).map(|(level, n)| (f64::from(level), up_to(n, last))).collect(),
        mark: Mark::Bars,
    });
    Plot {
        name: "budget_parts".into(),
        title: "Parts of a tick (thesis, fig. B.1)".into(),
        labels: ["level".into(), "of the tick".into()],
        axes: Axes::Named(LEVELS.map(|n| format!("{n} × {n}")).to_vec()),
        series: series.collect(),
    }
}
