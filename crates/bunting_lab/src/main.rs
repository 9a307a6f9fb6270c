//! `bunting_lab COMMAND [--json] [--out DIR] [--quick]`.

use std::process::ExitCode;

use bunting_lab::cli::Arguments;
use clap::Parser;

fn main() -> ExitCode {
    match Arguments::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bunting_lab: {error:#}");
            ExitCode::FAILURE
        }
    }
}
