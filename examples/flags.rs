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

use std::path::PathBuf;
use std::process::ExitCode;

use bunting_examples::Options;
use bunting_examples::scenes::flags::Flags;
use clap::Parser;

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

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let flags =
        arguments.scene.map_or_else(Flags::load, |file| bunting_scenes::load(file).map(Flags));
    match flags {
        Ok(flags) => arguments.options.run(&flags),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(BAD_SCENE)
        }
    }
}
