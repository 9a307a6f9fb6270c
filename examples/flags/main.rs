//! Eight flags, two of them on driving vehicles, in gusty wind.
//!
//! `cargo run --release --example flags -- --headless` simulates 20 seconds as fast as possible and prints
//! the cost of each phase. Compare the total with the budget of one millisecond a tick, and see how the
//! levels of detail follow the viewer and how little the cloth stretches.
//!
//! `cargo run --release --example flags --features render` opens a window: drag to look around,
//! scroll to come closer. No two flags fly alike, and the vehicles' flags stay on their poles. The
//! title of the window shows the cost and these keys:
//!
//! | Key | |
//! | --- | --- |
//! | ↑ ↓ | stronger and weaker wind |
//! | W | wind off and on |
//! | L | levels of detail: green is the finest, then yellow, orange and red |
//! | D | attachments (crosses), strain (red is long, blue is short), wind (arrows) |
//! | P | pause |

#[cfg(feature = "render")]
mod draw;
mod record;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bunting_examples::{ASSETS, Example, Options, Record};
use bunting_scenes::Scene;
use clap::Parser;

use crate::record::FlagsRecord;

/// Exit code for a scene that cannot be read.
const BAD_SCENE: u8 = 2;

/// Flags in the wind.
#[derive(Debug, Parser)]
struct Arguments {
    /// The scene to load instead of assets/scenes/flags.ron.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

/// A scene of flags from a file.
struct Flags(Scene);

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let file = arguments.scene.unwrap_or_else(|| PathBuf::from(ASSETS).join("scenes/flags.ron"));
    match bunting_scenes::load(file) {
        Ok(scene) => arguments.options.run(&Flags(scene)),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(BAD_SCENE)
        }
    }
}

impl Example for Flags {
    const NAME: &'static str = "Flags";
    const SECONDS: f64 = 20.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, bunting_scenes::follow_tracks);
        bunting_scenes::spawn(&mut app.world_mut().commands(), &self.0);
    }

    fn record(&self, ticks_per_second: usize) -> impl Record {
        FlagsRecord::new(&self.0, ticks_per_second)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> bunting_examples::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        draw::control(app, self.0.viewer.looks_at);
    }
}
