//! A section of the report.

use std::time::Duration;

use super::findings::{self, Finding};
use crate::output::Outcome;

/// Results of one command.
#[derive(Debug)]
pub struct Section {
    /// Name of the command.
    pub command: &'static str,
    /// Command line that repeats the measurement.
    pub command_line: String,
    /// Purpose of the command, in a sentence.
    pub measures: &'static str,
    /// Outcome, or the reason why there is none.
    pub outcome: Result<Outcome, String>,
    /// Wall-clock time of the command.
    pub took: Duration,
}

impl Section {
    /// Findings about the command's figures.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        match &self.outcome {
            Ok(outcome) => findings::of(self.command, &outcome.json),
            Err(reason) => vec![Finding::new(false, format!("not measured: {reason}"))],
        }
    }
}
