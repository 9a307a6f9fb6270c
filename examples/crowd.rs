//! A plaza of 1,000 flags and banners, seen from a flying camera, within a budget of one millisecond
//! a tick.
//!
//! `cargo run --release --example crowd -- --headless` flies once round the plaza as fast as possible
//! and prints a table.
//!
//! `cargo run --release --example crowd --features render` opens a window. Its title shows the cost
//! of the cloth, and how many cloths are simulated at each level of detail and asleep. Reduce the
//! budget and colour the cloth by level: it becomes coarser from far to near, and none pops.
//!
//! | Key | |
//! | --- | --- |
//! | ↑ ↓ | larger and smaller budget |
//! | L | colours by level of detail: green is the finest, then yellow, orange and red |
//! | P | pause |
//!
//! With `--headless --pictures DIR` it writes pictures, with `--levels` coloured by level.

use std::process::ExitCode;
use std::time::Duration;

use bevy_bunting::prelude::*;
use bunting_examples::Options;
use bunting_examples::scenes::crowd::Crowd;
use clap::Parser;

/// A crowd of flags.
#[derive(Debug, Parser)]
struct Arguments {
    /// Number of flags and banners.
    #[arg(long, default_value_t = 1000)]
    cloths: usize,
    /// Budget of all cloth in a tick, ms.
    #[arg(long, default_value = "1", value_parser = milliseconds)]
    budget: Duration,
    /// Colour cloth by level of detail.
    #[cfg(feature = "render")]
    #[arg(long)]
    levels: bool,
    #[command(flatten)]
    options: Options,
}

fn milliseconds(text: &str) -> Result<Duration, String> {
    let value: f64 = text.parse().map_err(|error| format!("{error}"))?;
    Duration::try_from_secs_f64(1e-3 * value).map_err(|error| format!("{error}"))
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let crowd = Crowd {
        cloths: arguments.cloths,
        budget: ClothBudget { tick: arguments.budget, ..ClothBudget::default() },
        #[cfg(feature = "render")]
        levels: arguments.levels,
    };
    arguments.options.run(&crowd)
}
