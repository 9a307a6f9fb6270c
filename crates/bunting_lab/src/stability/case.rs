//! A hard case: one measured value and the limit that it must not exceed.

use serde::Serialize;

/// Whether a case was run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The case was run.
    Built,
    /// The product or this machine lacks a feature that the case needs.
    NotBuilt,
}

/// A hard case and its result.
#[derive(Clone, Debug, Serialize)]
pub struct HardCase {
    /// Name.
    pub name: String,
    /// Vertices along each side; zero if the case has no single size.
    pub n: usize,
    /// Description of the value, with its unit.
    pub figure: &'static str,
    /// Worst measured value; none if nothing was measured, or if it was not a number.
    pub worst: Option<f64>,
    /// Worst value that passes.
    pub limit: f64,
    /// Whether it passed.
    pub pass: bool,
    /// Whether the case was run.
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

    /// A case that was not run because the product or this machine lacks a feature.
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
