//! A part of the report.

use std::time::Duration;

use super::findings::{self, Finding};
use crate::output::Outcome;

/// What one command measured.
#[derive(Debug)]
pub struct Section {
    /// Name of the command.
    pub command: &'static str,
    /// How the command is run to measure the same by itself.
    pub command_line: String,
    /// What it measures, in a sentence.
    pub measures: &'static str,
    /// What came out, or why nothing did.
    pub outcome: Result<Outcome, String>,
    /// How long it took.
    pub took: Duration,
}

impl Section {
    /// What its figures say.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        match &self.outcome {
            Ok(outcome) => findings::of(self.command, &outcome.json),
            Err(reason) => vec![Finding::new(false, format!("not measured: {reason}"))],
        }
    }
}
