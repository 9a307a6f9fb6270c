//! The command line.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::commands::{
    budget, contacts, effort, families, files, forces, fuzz, gate, lod, memory, nets, oracles,
    pareto, report, schedule, sharing, soak, stability,
};
use crate::output::Outcome;

/// Measures the cloth against references.
#[derive(Debug, Parser)]
#[command(version)]
pub struct Arguments {
    /// Measurement to run.
    #[command(subcommand)]
    command: Command,
    /// Print one JSON object on standard output and nothing else.
    #[arg(long, global = true)]
    json: bool,
    /// Also write CSV files and SVG plots into this folder.
    #[arg(long, global = true, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Measure less, in under 20 seconds.
    #[arg(long, global = true)]
    quick: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Closed forms compared with measurements.
    Oracles(families::Selection),
    /// Error over time of every method.
    Pareto(pareto::Selection),
    /// Cloths in a budget of time.
    Budget,
    /// Agreement of the levels of detail, and the jumps between them.
    Lod,
    /// Substeps by need beside fixed ones, in winds from light to storm.
    Effort,
    /// Contacts compared with closed forms, and shapes that must not pass through cloth.
    Contacts(families::Selection),
    /// Wind with a place and forces, compared with what their documentation states.
    Forces(families::Selection),
    /// Meshes, pins, materials, winds and jerks at random.
    Fuzz(fuzz::Selection),
    /// Bytes of a chain of levels and of batches.
    Memory,
    /// Meshes of the OBJ and glTF files of a folder as cloths.
    Files {
        /// The folder.
        folder: PathBuf,
        /// Only files whose names contain this.
        filter: Option<String>,
    },
    /// Time of garments, beside that of a grid.
    Nets,
    /// The hard cases.
    Stability(families::Selection),
    /// Cost of the schedule over plain calls.
    Schedule,
    /// Flags that need different substeps, in batches that they share.
    Sharing,
    /// Scenes that run for long: memory, times and motion at the end beside those at the start.
    Soak(soak::Options),
    /// Other engines on the same scenes.
    Peers,
    /// Hashes, closed forms and quick hard cases against the committed lists; exits with 1 where they differ.
    Gate(gate::Options),
    /// All of it, as one HTML page and as `docs/measurements.md`.
    Report(report::Options),
}

impl Arguments {
    /// Runs the command and presents its results.
    ///
    /// # Errors
    ///
    /// When a command cannot run or its files cannot be written.
    pub fn run(self) -> Result<()> {
        let outcome = match self.command {
            Command::Pareto(selection) => pareto::run(&selection, self.quick)?,
            Command::Lod => lod::run(self.quick),
            Command::Peers => peers(self.quick)?,
            Command::Schedule => schedule::run(self.quick),
            Command::Sharing => sharing::run(self.quick),
            Command::Soak(options) => soak::run(&options, self.quick)?,
            Command::Budget => budget::run(self.quick),
            Command::Effort => effort::run(self.quick),
            Command::Contacts(selection) => contacts::run(&selection, self.quick)?,
            Command::Forces(selection) => forces::run(&selection, self.quick)?,
            Command::Fuzz(selection) => fuzz::run(&selection),
            Command::Files { folder, filter } => files::run(&folder, filter.as_deref())?,
            Command::Nets => nets::run(),
            Command::Memory => memory::run(),
            Command::Oracles(selection) => oracles::run(&selection)?,
            Command::Stability(selection) => stability::run(&selection, self.quick)?,
            Command::Gate(options) => {
                return gate::run(options, |outcome| {
                    outcome.present(self.json, self.out.as_deref())
                });
            }
            Command::Report(options) => report::run(&options, self.quick, self.out.as_deref())?,
        };
        outcome.present(self.json, self.out.as_deref())
    }
}

#[cfg(feature = "peers")]
fn peers(quick: bool) -> Result<Outcome> {
    Ok(crate::commands::peers::run(quick))
}

#[cfg(not(feature = "peers"))]
fn peers(_quick: bool) -> Result<Outcome> {
    anyhow::bail!("peers are not built in: run with --features peers")
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn bad_arguments_exit_with_two() {
        for arguments in
            [&["bunting_lab", "nonsense"][..], &["bunting_lab", "pareto", "--sizes", "two"]]
        {
            let error = Arguments::try_parse_from(arguments).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{arguments:?}");
        }
    }
}
