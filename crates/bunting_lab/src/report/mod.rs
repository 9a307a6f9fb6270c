//! One page that says what was measured, on what, what is good and what is not.

pub mod findings;
pub mod machine;
pub mod page;

use std::time::Duration;

use crate::output::Outcome;

/// What one command measured.
#[derive(Debug)]
pub struct Section {
    /// Name of the command.
    pub command: &'static str,
    /// What it measures, in a sentence.
    pub measures: &'static str,
    /// What came out.
    pub outcome: Outcome,
    /// How long it took.
    pub took: Duration,
}
