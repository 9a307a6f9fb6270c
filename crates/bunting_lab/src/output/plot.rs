//! Plots as SVG.

use std::{fs, path::Path};

use anyhow::{Context, Result, anyhow};
use plotters::{coord::Shift, prelude::*};

/// Width and height of a plot in pixels.
const SIZE: (u32, u32) = (900, 600);
/// Free space round the outermost points, as a factor on logarithmic axes.
const MARGIN: f64 = 1.6;
/// Width of a bar on the horizontal axis, whose bars stand at whole numbers.
const BAR: f64 = 0.7;

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Dots.
    Dots,
    /// A line through the points in order.
    Line,
    /// Bars from zero to the points. A series covers those before it: stacked bars are cumulative
    /// sums, the largest first.
    Bars,
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points, all positive where the axes are logarithmic.
    pub points: Vec<(f64, f64)>,
    /// How they are drawn.
    pub mark: Mark,
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// File name without its ending.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Names of the horizontal and vertical axis, with units.
    pub axes: [String; 2],
    /// Whether both axes are logarithmic.
    pub logarithmic: bool,
    /// What is plotted.
    pub series: Vec<Series>,
}

impl Plot {
    /// Writes `name.svg` into the folder.
    ///
    /// # Errors
    ///
    /// When nothing is there to plot or the file cannot be written.
    pub fn write_svg(&self, folder: &Path) -> Result<()> {
        let path = folder.join(format!("{}.svg", self.name));
        fs::write(&path, self.svg()?).with_context(|| format!("cannot write {}", path.display()))
    }

    /// The plot as an SVG document.
    ///
    /// # Errors
    ///
    /// When nothing is there to plot.
    pub fn svg(&self) -> Result<String> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
            .with_context(|| format!("cannot plot {}", self.name))?;
        Ok(svg)
    }

    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<()> {
        let [x, y] = self.ranges().ok_or_else(|| anyhow!("no points"))?;
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(area);
        chart
            .caption(&self.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(45)
            .y_label_area_size(70);
        if self.logarithmic {
            let mut chart =
                chart.build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
            chart.configure_mesh().x_desc(&self.axes[0]).y_desc(&self.axes[1]).draw()?;
            self.draw_series(&mut chart)?;
        } else {
            let mut chart = chart.build_cartesian_2d(x.0..x.1, y.0..y.1)?;
            chart.configure_mesh().x_desc(&self.axes[0]).y_desc(&self.axes[1]).draw()?;
            self.draw_series(&mut chart)?;
        }
        Ok(area.present()?)
    }

    fn draw_series<'a, 'b: 'a, X, Y>(
        &self,
        chart: &mut ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Result<()>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        for (k, series) in self.series.iter().enumerate() {
            let colour = Palette99::pick(k).to_rgba();
            let points = series.points.iter().copied();
            let drawn = match series.mark {
                Mark::Dots => {
                    chart.draw_series(points.map(|p| Circle::new(p, 4, colour.filled())))?
                }
                Mark::Line => chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?,
                Mark::Bars => chart.draw_series(points.map(|(x, y)| {
                    let corners = [(x - BAR / 2.0, 0.0), (x + BAR / 2.0, y)];
                    Rectangle::new(corners, colour.filled())
                }))?,
            };
            drawn
                .label(&series.name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    }

    /// Extent of both axes.
    fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        points().next()?;
        let extent = |axis: fn(&(f64, f64)) -> f64| {
            let (low, high) =
                points().map(axis).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                });
            if self.logarithmic { (low / MARGIN, high * MARGIN) } else { (low, high) }
        };
        let (x, y) = (extent(|p| p.0), extent(|p| p.1));
        let has_bars = self.series.iter().any(|series| series.mark == Mark::Bars);
        Some(if has_bars { [(x.0 - BAR, x.1 + BAR), (0.0, y.1)] } else { [x, y] })
    }
}

/// The points that no other point beats on both axes, from left to right.
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
    fn the_front_drops_what_is_beaten() {
        let points = [(4.0, 1.0), (1.0, 4.0), (3.0, 5.0), (2.0, 2.0), (2.0, 3.0)];
        assert_eq!(pareto_front(&points), [(1.0, 4.0), (2.0, 2.0), (4.0, 1.0)]);
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
            axes: ["µs".into(), "m".into()],
            logarithmic: true,
            series,
        };
        plot.write_svg(&folder).unwrap();
        let svg = std::fs::read_to_string(folder.join("test.svg")).unwrap();
        assert!(svg.contains("<circle") && svg.contains("A test"));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
