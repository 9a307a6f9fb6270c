//! Plots as SVG.

use std::{fs, path::Path};

use anyhow::{Context, Result, anyhow};
use plotters::{coord::Shift, prelude::*};

/// Width and height of a plot in pixels.
const SIZE: (u32, u32) = (1000, 600);
/// Width of the legend, which stands beside the chart, pixels.
const LEGEND: u32 = 250;
/// Height of a line of the legend.
const LINE: i32 = 26;
/// Sizes of the letters of titles and of labels, pixels.
const LETTERS: (u32, u32) = (24, 17);
/// Free space around the outermost points, as a factor on logarithmic axes.
const MARGIN: f64 = 1.6;
/// Width of a bar, in units of the horizontal axis; bars stand at whole numbers.
const BAR: f64 = 0.7;
/// Colours of series in their order: those of Okabe and Ito 2008, which colour-blind people can distinguish,
/// and some more.
const COLOURS: [RGBColor; 12] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(110, 80, 50),
    RGBColor(150, 150, 150),
    RGBColor(120, 60, 160),
    RGBColor(0, 0, 0),
    RGBColor(128, 128, 0),
    RGBColor(160, 30, 60),
];

/// Style in which the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Dots.
    Dots,
    /// A line through the points in order.
    Line,
    /// A grey line under everything else: a front or a limit.
    Guide,
    /// Bars from zero to the points, drawn in the order of the series. Stacked bars are series of cumulative
    /// sums, the largest first.
    Bars,
}

/// Points that are drawn alike.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points, all positive where the axes are logarithmic. A series without points takes a colour, so that
    /// the others keep theirs in every plot, but is not in the legend.
    pub points: Vec<(f64, f64)>,
    /// Style in which the points are drawn.
    pub mark: Mark,
}

/// Scales of the axes.
#[derive(Clone, Debug)]
pub enum Axes {
    /// Both logarithmic.
    Logarithmic,
    /// A name at each of 0, 1, 2 … along the horizontal axis; the vertical one is linear.
    Named(Vec<String>),
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// File name without its ending.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Names of the horizontal and vertical axis, with units.
    pub labels: [String; 2],
    /// Scales of the axes.
    pub axes: Axes,
    /// The plotted series.
    pub series: Vec<Series>,
}

impl Plot {
    /// Writes `name.svg` into the folder.
    ///
    /// # Errors
    ///
    /// There is nothing to plot, or the file cannot be written.
    pub fn write_svg(&self, folder: &Path) -> Result<()> {
        let path = folder.join(format!("{}.svg", self.name));
        fs::write(&path, self.svg()?).with_context(|| format!("cannot write {}", path.display()))
    }

    /// The plot as an SVG document.
    ///
    /// # Errors
    ///
    /// There is nothing to plot.
    pub fn svg(&self) -> Result<String> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
            .with_context(|| format!("cannot plot {}", self.name))?;
        Ok(svg)
    }

    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<()> {
        let [x, y] = self.ranges().ok_or_else(|| anyhow!("no points"))?;
        area.fill(&WHITE)?;
        let (left, right) = area.split_horizontally(SIZE.0 - LEGEND);
        self.draw_legend(&right)?;
        let mut chart = ChartBuilder::on(&left);
        chart
            .caption(&self.title, ("sans-serif", LETTERS.0))
            .margin(12)
            .x_label_area_size(60)
            .y_label_area_size(85);
        match &self.axes {
            Axes::Logarithmic => {
                let mut chart =
                    chart.build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
                chart
                    .configure_mesh()
                    .x_desc(&self.labels[0])
                    .y_desc(&self.labels[1])
                    .label_style(("sans-serif", LETTERS.1))
                    .x_label_formatter(&power)
                    .y_label_formatter(&power)
                    .light_line_style(BLACK.mix(0.06))
                    .draw()?;
                self.draw_series(&mut chart)
            }
            Axes::Named(names) => {
                let mut chart = chart.build_cartesian_2d(x.0..x.1, y.0..y.1)?;
                let name = |at: &f64| {
                    let whole = (at.fract() == 0.0).then_some(*at as usize);
                    whole.and_then(|at| names.get(at)).cloned().unwrap_or_default()
                };
                chart
                    .configure_mesh()
                    .disable_x_mesh()
                    .x_desc(&self.labels[0])
                    .y_desc(&self.labels[1])
                    .label_style(("sans-serif", LETTERS.1))
                    .x_label_formatter(&name)
                    .light_line_style(TRANSPARENT)
                    .draw()?;
                self.draw_series(&mut chart)
            }
        }?;
        Ok(area.present()?)
    }

    /// Every series with its colour; a guide has no colour of its own.
    fn coloured(&self) -> impl Iterator<Item = (&Series, RGBColor)> {
        let mut colours = COLOURS.iter().cycle();
        self.series.iter().map(move |series| match series.mark {
            Mark::Guide => (series, RGBColor(90, 90, 90)),
            _ => (series, *colours.next().expect("a cycle")),
        })
    }

    fn draw_series<'a, 'b: 'a, X, Y>(
        &self,
        chart: &mut ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Result<()>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let mut coloured: Vec<_> = self.coloured().collect();
        coloured.sort_by_key(|(series, _)| series.mark != Mark::Guide);
        for (series, colour) in coloured {
            let points = series.points.iter().copied();
            match series.mark {
                Mark::Dots => {
                    chart.draw_series(points.map(|p| Circle::new(p, 5, colour.filled())))?
                }
                Mark::Line => chart.draw_series(LineSeries::new(points, colour.stroke_width(3)))?,
                Mark::Guide => {
                    chart.draw_series(LineSeries::new(points, colour.stroke_width(1)))?
                }
                Mark::Bars => chart.draw_series(points.map(|(x, y)| {
                    let corners = [(x - BAR / 2.0, 0.0), (x + BAR / 2.0, y)];
                    Rectangle::new(corners, colour.filled())
                }))?,
            };
        }
        Ok(())
    }

    fn draw_legend(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<()> {
        let shown = self.coloured().filter(|(series, _)| !series.points.is_empty());
        for (line, (series, colour)) in (2..).zip(shown) {
            let middle = line * LINE;
            match series.mark {
                Mark::Dots => area.draw(&Circle::new((12, middle), 5, colour.filled()))?,
                Mark::Line | Mark::Guide => {
                    let width = if series.mark == Mark::Line { 3 } else { 1 };
                    let ends = vec![(3, middle), (21, middle)];
                    area.draw(&PathElement::new(ends, colour.stroke_width(width)))?;
                }
                Mark::Bars => {
                    let corners = [(5, middle - 7), (19, middle + 7)];
                    area.draw(&Rectangle::new(corners, colour.filled()))?;
                }
            }
            let style = ("sans-serif", LETTERS.1);
            area.draw(&Text::new(series.name.clone(), (30, middle - 8), style))?;
        }
        Ok(())
    }

    /// Extent of both axes.
    fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        points().next()?;
        let extent = |axis: fn(&(f64, f64)) -> f64| {
            points().map(axis).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(v), high.max(v))
            })
        };
        let (x, y) = (extent(|p| p.0), extent(|p| p.1));
        Some(match self.axes {
            Axes::Logarithmic => [x, y].map(|(low, high)| (low / MARGIN, high * MARGIN)),
            Axes::Named(_) => [(x.0 - BAR, x.1 + BAR), (0.0, y.1)],
        })
    }
}

/// Label of a logarithmic axis: one digit times a power of ten, or a plain number if that is short.
fn power(value: &f64) -> String {
    let text = format!("{value:.0e}");
    let plain = text.parse().ok().filter(|digit: &f64| (1e-3..1e5).contains(digit));
    plain.map_or(text, |digit| digit.to_string())
}

/// The points that no other point dominates on both axes, from left to right.
#[must_use]
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in sorted {
        if front.last().is_none_or(|last| point.1 < last.1) {
            front.push(point);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_drops_dominated_points() {
        let points = [(4.0, 1.0), (1.0, 4.0), (3.0, 5.0), (2.0, 2.0), (2.0, 3.0)];
        assert_eq!(pareto_front(&points), [(1.0, 4.0), (2.0, 2.0), (4.0, 1.0)]);
    }

    #[test]
    fn labels_are_short() {
        let labels = [9.999_999_999e-6, 3.000_000_000_1e-2, 1e3, 2e5].map(|value| power(&value));
        assert_eq!(labels, ["1e-5", "0.03", "1000", "2e5"]);
    }

    #[test]
    fn a_plot_becomes_svg() {
        let folder = std::env::temp_dir().join(format!("bunting-lab-plot-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let series = vec![Series {
            name: "dots".into(),
            points: vec![(1.0, 1e-3), (10.0, 1e-5)],
            mark: Mark::Dots,
        }];
        let plot = Plot {
            name: "test".into(),
            title: "A test".into(),
            labels: ["µs".into(), "m".into()],
            axes: Axes::Logarithmic,
            series,
        };
        plot.write_svg(&folder).unwrap();
        let svg = std::fs::read_to_string(folder.join("test.svg")).unwrap();
        assert!(svg.contains("<circle") && svg.contains("A test"));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
