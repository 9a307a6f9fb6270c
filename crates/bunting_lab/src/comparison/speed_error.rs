//! Plots of error over time.

use super::row::Row;
use crate::{
    contender::Contender,
    observation::COMPARED_TICKS,
    output::plot::{Axes, Mark, Plot, Series, pareto_front},
    scenes::{Measure, Scene, TICK_RATE},
};

/// Methods of the figure that compares position-based methods: the beginning of a method's name, the number
/// of cloths at once (none for any), and the text of the legend.
const FIGURE: [(&str, Option<usize>, &str); 8] = [
    ("bunting yarns", Some(16), "this project, of 16 at once"),
    ("bunting yarns", Some(1), "this project, alone"),
    ("bunting Gauss–Seidel", Some(16), "its Gauss–Seidel, of 16"),
    ("HPBD", None, "HPBD, plain code"),
    ("XPBD", None, "XPBD, plain code"),
    ("PBD", None, "PBD, plain code"),
    ("Jakobsen", None, "Jakobsen, plain code"),
    ("rapier", None, "rapier 0.36"),
];

/// Plot of error over time of every method on a scene, one colour for each method, for one cloth alone and
/// for the largest number at once, with the Pareto front. A contender has the same colour on every scene.
/// None if no method has an error.
#[must_use]
pub fn plot(scene: &Scene, rows: &[Row], contenders: &[Contender]) -> Option<Plot> {
    let widest = contenders.iter().map(|it| it.lanes).max()?;
    let mut methods: Vec<(&str, usize)> = Vec::new();
    for it in contenders.iter().map(|contender| (contender.method.as_str(), contender.lanes)) {
        if (it.1 == 1 || it.1 == widest) && !methods.contains(&it) {
            methods.push(it);
        }
    }
    let series: Vec<Series> = methods
        .into_iter()
        .map(|(method, lanes)| {
            let of_method = rows.iter().filter(|row| row.method == method && row.lanes == lanes);
            let points = of_method.filter_map(|row| point(scene, row)).collect();
            let name = if lanes == 1 { method.to_owned() } else { format!("{method}, of {lanes}") };
            Series { name, points, mark: Mark::Dots }
        })
        .collect();
    let title = format!("{} {n} × {n}", scene.name, n = scene.columns);
    let has_points = series.iter().any(|series| !series.points.is_empty());
    has_points.then(|| with_front(scene, title, series))
}

/// Plot of error over time of the position-based methods on a scene.
#[must_use]
pub fn figure(scene: &Scene, rows: &[Row]) -> Plot {
    let series = FIGURE.iter().filter_map(|&(method, lanes, name)| {
        let of_method = rows.iter().filter(|row| {
            row.method.starts_with(method) && lanes.is_none_or(|lanes| row.lanes == lanes)
        });
        let points: Vec<_> = of_method.filter_map(|row| point(scene, row)).collect();
        let name = name.to_owned();
        (!points.is_empty()).then_some(Series { name, points, mark: Mark::Dots })
    });
    let title = format!("A cloth of {n} × {n} swings: error over time", n = scene.columns);
    with_front(scene, title, series.collect())
}

fn point(scene: &Scene, row: &Row) -> Option<(f64, f64)> {
    Some((row.us_per_cloth_tick, row.error(scene.measure)?))
}

fn with_front(scene: &Scene, title: String, mut series: Vec<Series>) -> Plot {
    let points: Vec<(f64, f64)> = series.iter().flat_map(|s| s.points.clone()).collect();
    let front = pareto_front(&points);
    series.push(Series { name: "Pareto front".into(), points: front, mark: Mark::Guide });
    let error = match scene.measure {
        Measure::Positions => {
            let seconds = COMPARED_TICKS[1] as f64 / f64::from(TICK_RATE);
            format!("RMS position error after {seconds:.1} s, m")
        }
        Measure::Rest | Measure::Statistics => "error of the mean strain".into(),
    };
    Plot {
        name: format!("pareto_{}_{}", scene.name, scene.columns),
        title,
        labels: ["time of one cloth's tick, µs".into(), error],
        axes: Axes::Logarithmic,
        series,
    }
}
