//! The interface of an example, and the part of the command line that all examples share.

use std::process::ExitCode;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use clap::{Args, Parser};

use crate::headless;
#[cfg(feature = "render")]
use crate::render::{
    pictures::{self, PictureOptions},
    stage::Stage,
    window,
};

/// A scene of cloth: its entities, its measurements and, with the feature `render`, its look.
pub trait Example {
    /// Title of the window, and the start of the names of pictures.
    const NAME: &'static str;

    /// Simulated time of a headless run unless the command line sets it, s.
    const SECONDS: f64;

    /// Spawns cloths, winds and one `LodViewer`, and adds the systems that move them to `schedule`. In a
    /// headless run this is `FixedUpdate`, which makes the bits reproducible; in a window it is `Update`,
    /// which makes motion smooth at any frame rate.
    fn build(&self, app: &mut App, schedule: impl ScheduleLabel);

    /// An empty record of a headless run with this number of ticks per second.
    fn record(&self, ticks_per_second: usize) -> impl Record;

    /// Sky, ground and light.
    #[cfg(feature = "render")]
    fn stage(&self) -> Stage;

    /// Adds the plugins that give meshes and materials to the entities of [`build`](Self::build).
    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App);

    /// Adds the controls of a window: a camera that the mouse moves, and keys.
    #[cfg(feature = "render")]
    fn control(&self, app: &mut App);
}

/// Measurements of a headless run.
pub trait Record {
    /// Adds the tick that has just been simulated. Returns a line to print at once, if any.
    fn add_tick(&mut self, world: &mut World) -> Option<String>;

    /// Prints all measurements. Returns whether every measured value is within its limit.
    fn print(&self) -> bool;
}

/// The part of the command line that all examples share.
#[derive(Clone, Debug, Args)]
pub struct Options {
    /// Simulate as fast as possible, without a window, and print measurements.
    #[arg(long)]
    headless: bool,
    /// Simulated time in seconds.
    #[arg(long, value_parser = positive, requires = "headless")]
    pub(crate) seconds: Option<f64>,
    /// Number of threads that simulate cloth.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..), requires = "headless")]
    pub(crate) threads: u16,
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) pictures: PictureOptions,
}

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

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("must be positive".to_owned()) }
}

impl Options {
    /// Whether there is no window.
    #[must_use]
    pub fn headless(&self) -> bool {
        self.headless
    }

    /// These options, but headless runs end after a time (s), of which pictures are written.
    #[must_use]
    pub fn until(&self, time: f64) -> Self {
        Self {
            seconds: Some(time),
            #[cfg(feature = "render")]
            pictures: self.pictures.at(time),
            ..self.clone()
        }
    }

    /// Runs an example headless, with or without pictures, or in a window.
    #[cfg(feature = "render")]
    pub fn run<E: Example>(&self, example: &E) -> ExitCode {
        if !self.headless {
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
        if self.headless {
            return headless::run(example, self);
        }
        eprintln!("this build has no window: pass --headless, or build with --features render");
        ExitCode::FAILURE
    }
}
