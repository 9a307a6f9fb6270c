//! Runs examples as the command line says.

use std::process::ExitCode;

use clap::Parser;

#[cfg(feature = "render")]
use crate::render::{pictures, window};
use crate::{Example, Options, headless};

/// Runs an example as the command line says. It has no options but those that all examples share.
#[must_use]
pub fn run(example: &impl Example) -> ExitCode {
    Arguments::parse().options.run(example)
}

/// An example of bevy_bunting.
#[derive(Debug, Parser)]
struct Arguments {
    #[command(flatten)]
    options: Options,
}

impl Options {
    /// Runs an example headless, with or without pictures, or in a window.
    #[cfg(feature = "render")]
    pub fn run<E: Example>(&self, example: &E) -> ExitCode {
        if !self.headless() {
            return window::run(example);
        }
        match self.pictures.open(E::NAME) {
            Some(pictures) => pictures::run(example, self, pictures),
            None => headless::run(example, self),
        }
    }

    /// Runs an example headless: this build cannot open a window.
    #[cfg(not(feature = "render"))]
    pub fn run(&self, example: &impl Example) -> ExitCode {
        if self.headless() {
            return headless::run(example, self);
        }
        eprintln!("this build has no window: pass --headless, or build with --features render");
        ExitCode::FAILURE
    }
}
