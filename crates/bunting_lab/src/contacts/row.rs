//! A row of the table of contacts: one figure and the limit that it must not exceed.

use serde::Serialize;

/// One measured figure.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name, unique among all rows.
    pub name: String,
    /// Description of the figure, with its unit.
    pub quantity: &'static str,
    /// The worst measured value; none if it was not a number.
    pub figure: Option<f64>,
    /// Greatest value that passes.
    pub limit: f64,
    /// Whether it passed.
    pub pass: bool,
    /// Mean time of a tick, with all its contacts, µs.
    pub us: f64,
    /// Whether the figure is of times, which no two runs agree on.
    pub is_of_times: bool,
}

impl Row {
    /// A row. A figure that is not a number fails.
    pub(crate) fn new(
        name: impl Into<String>,
        quantity: &'static str,
        figure: f64,
        limit: f64,
        us: f64,
    ) -> Self {
        Self {
            name: name.into(),
            quantity,
            figure: figure.is_finite().then_some(figure),
            limit,
            pass: figure <= limit,
            us,
            is_of_times: false,
        }
    }

    /// The row of a figure that is a time, or a ratio of times.
    #[must_use]
    pub(crate) fn of_times(self) -> Self {
        Self { is_of_times: true, ..self }
    }
}
