//! Eight flags, two of them on driving vehicles, in gusty wind.
//!
//! `cargo run --release --example flags` shows them; drag to look around, scroll to come closer.
//! Look at how no two flags fly alike, how the vehicles' flags stay on their poles, and at the
//! shadows. The title of the window tells what it costs, and these keys:
//!
//! | Key | |
//! | --- | --- |
//! | ↑ ↓ | stronger and weaker wind |
//! | W | wind off and on |
//! | L | levels of detail: green is the finest, then yellow, orange and red |
//! | D | attachments (crosses), strain (red is long, blue is short), wind (arrows) |
//! | P | pause |
//!
//! `cargo run --release --example flags -- --headless` simulates 20 seconds as fast as it goes and
//! prints where the time went. Look at the total beside its budget of one millisecond a tick, at
//! how the levels of detail follow the viewer, and at the strain: cloth hardly stretches.

mod headless;
mod material;
mod record;
mod road;
mod stage;
mod table;
mod window;

use std::path::PathBuf;
use std::process::ExitCode;

use bunting_examples::pictures::Album;
use bunting_examples::{ASSETS, any_display};
use clap::Parser;

use crate::headless::Run;

/// Exit code for a scene that cannot be read.
const BAD_SCENE: u8 = 2;

/// Flags in the wind.
#[derive(Debug, Parser)]
struct Arguments {
    /// The scene to load instead of assets/scenes/flags.ron.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Simulate as fast as it goes, without a window, and print what was measured.
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    run: Run,
    #[command(flatten)]
    album: Album,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let file = arguments.scene.unwrap_or_else(|| PathBuf::from(ASSETS).join("scenes/flags.ron"));
    let scene = match bunting_scenes::load(file) {
        Ok(scene) => scene,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(BAD_SCENE);
        }
    };
    if arguments.headless {
        headless::run(&scene, &arguments.run, &arguments.album);
        ExitCode::SUCCESS
    } else if any_display() {
        window::run(&scene)
    } else {
        eprintln!("no display can be opened: use --headless");
        ExitCode::FAILURE
    }
}
