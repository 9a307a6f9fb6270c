//! The commands of the command line.

pub mod ablation;
pub mod budget;
pub mod contacts;
mod differences;
pub mod effort;
pub mod families;
mod figures;
pub mod files;
pub mod forces;
pub mod fuzz;
pub mod gate;
mod gate_cases;
mod gate_jobs;
pub mod lod;
pub mod memory;
pub mod nets;
pub mod oracles;
pub mod pareto;
#[cfg(feature = "peers")]
pub mod peers;
pub mod report;
pub mod schedule;
pub mod sharing;
pub mod soak;
pub mod stability;

use indicatif::{ProgressBar, ProgressStyle};

/// Progress bar on standard error for `length` pieces of work; nothing if standard error is not a terminal.
#[must_use]
pub fn progress(length: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}")
        .expect("a constant template");
    ProgressBar::new(length as u64).with_style(style)
}
