//! A plot of cases and their limits.

use super::plot::{Axes, Mark, Plot, Series};

/// A measured value and its limit.
#[derive(Clone, Copy, Debug)]
pub struct Verdict {
    /// Measured value.
    pub worst: f64,
    /// Largest value that passes.
    pub limit: f64,
    /// Whether it passed.
    pub pass: bool,
}

/// Plots every case as a dot, below the line if it passes. Logarithmic axes leave out values and limits of
/// zero. None if nothing is left.
#[must_use]
pub fn plot(name: &str, title: &str, labels: [&str; 2], cases: &[Verdict]) -> Option<Plot> {
    let shown = cases.iter().filter(|case| case.worst > 0.0 && case.limit > 0.0);
    let shown: Vec<&Verdict> = shown.filter(|case| case.worst.is_finite()).collect();
    let limits = shown.iter().map(|case| case.limit);
    let ends = [limits.clone().fold(f64::INFINITY, f64::min), limits.fold(0.0, f64::max)];
    let dots = |pass: bool, name: &str| Series {
        name: name.into(),
        points: shown.iter().filter(|it| it.pass == pass).map(|it| (it.limit, it.worst)).collect(),
        mark: Mark::Dots,
    };
    let line =
        Series { name: "limit".into(), points: ends.map(|at| (at, at)).into(), mark: Mark::Guide };
    (!shown.is_empty()).then(|| Plot {
        name: name.into(),
        title: title.into(),
        labels: labels.map(str::to_owned),
        axes: Axes::Logarithmic,
        series: vec![dots(true, "passes"), dots(false, "fails"), line],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failing_cases_are_a_separate_series_and_zeros_are_left_out() {
        let case = |worst, limit| Verdict { worst, limit, pass: worst <= limit };
        let cases = [case(1e-3, 1e-2), case(1.0, 1e-2), case(0.0, 1.0), case(f64::INFINITY, 1.0)];
        let plot = plot("cases", "Cases", ["limit", "figure"], &cases).expect("two cases");
        let points = plot.series.iter().map(|series| series.points.len());
        assert_eq!(points.collect::<Vec<_>>(), [1, 1, 2]);
        assert!(plot.svg().is_ok());
    }
}
