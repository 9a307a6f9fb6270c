//! A hard case: one figure and the limit that it must not pass.

use serde::Serialize;

/// Whether a case could be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It was run.
    Built,
    /// The product or this machine lacks what it is about.
    NotBuilt,
}

/// A hard case and how it went.
#[derive(Clone, Debug, Serialize)]
pub struct HardCase {
    /// Name.
    pub name: String,
    /// Vertices along each side; zero where the case has no one size.
    pub n: usize,
    /// What the figure is, with its unit.
    pub figure: &'static str,
    /// The worst that was measured; none where nothing was, or it was not a number.
    pub worst: Option<f64>,
    /// The worst that passes.
    pub limit: f64,
    /// Whether it passed.
    pub pass: bool,
    /// Whether it was run.
    pub status: Status,
}

impl HardCase {
    /// A case that was run.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        n: usize,
        figure: &'static str,
        worst: f64,
        limit: f64,
    ) -> Self {
        Self {
            name: name.into(),
            n,
            figure,
            worst: worst.is_finite().then_some(worst),
            limit,
            pass: worst <= limit,
            status: Status::Built,
        }
    }

    /// A case that the product or this machine lacks something for.
    #[must_use]
    pub fn not_built(name: impl Into<String>, figure: &'static str, limit: f64) -> Self {
        Self {
            name: name.into(),
            n: 0,
            figure,
            worst: None,
            limit,
            pass: false,
            status: Status::NotBuilt,
        }
    }
}
