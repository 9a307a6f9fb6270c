//! A plaza of 1,000 flags and banners, seen from a camera in flight, within a budget of one
//! millisecond a tick.
//!
//! `cargo run --release --example crowd` shows it. Look at the title of the window: what the cloth
//! costs, and how many cloths are simulated at each level of detail and asleep. Then take time away
//! from it, and colour it by level: cloth becomes coarser from far to near, and none pops.
//!
//! | Key | |
//! | --- | --- |
//! | ↑ ↓ | more and less time |
//! | L | colours by level of detail: green is the finest, then yellow, orange and red |
//! | P | pause |
//!
//! `cargo run --release --example crowd -- --headless` flies once round as fast as it goes and prints
//! a table. With `--pictures DIR` it writes pictures, with `--levels` coloured by level.

mod colours;
mod controls;
mod flight;
mod headless;
mod plaza;
mod stage;
mod table;
mod window;

use std::process::ExitCode;
use std::time::Duration;

use bunting_examples::pictures::Album;
use clap::Parser;

use crate::headless::Run;

/// A crowd of flags.
#[derive(Debug, Parser)]
struct Arguments {
    /// Number of flags and banners.
    #[arg(long, default_value_t = 1000)]
    cloths: usize,
    /// What all of them may cost in a tick, ms.
    #[arg(long, default_value = "1", value_parser = milliseconds)]
    budget: Duration,
    /// Colour them by level of detail.
    #[arg(long)]
    levels: bool,
    /// Simulate as fast as it goes, without a window, and print what was measured.
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    run: Run,
    #[command(flatten)]
    album: Album,
}

fn milliseconds(text: &str) -> Result<Duration, String> {
    let value: f64 = text.parse().map_err(|error| format!("{error}"))?;
    Duration::try_from_secs_f64(1e-3 * value).map_err(|error| format!("{error}"))
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let crowd = plaza::Crowd {
        cloths: arguments.cloths,
        budget: arguments.budget,
        by_level: arguments.levels,
    };
    if arguments.headless {
        headless::run(&crowd, &arguments.run, &arguments.album);
        ExitCode::SUCCESS
    } else {
        window::run(&crowd)
    }
}
