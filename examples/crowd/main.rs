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

#[cfg(feature = "render")]
mod draw;
mod flight;
mod plaza;
mod record;

use std::process::ExitCode;
use std::time::Duration;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::{Example, Options, Record};
use clap::Parser;

use crate::record::CrowdRecord;

/// A crowd of flags.
#[derive(Debug, Parser)]
struct Crowd {
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
    let crowd = Crowd::parse();
    crowd.options.run(&crowd)
}

impl Example for Crowd {
    const NAME: &'static str = "Crowd";
    const SECONDS: f64 = flight::ROUND;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, flight::fly);
        app.world_mut().resource_mut::<ClothBudget>().tick = self.budget;
        plaza::spawn(&mut app.world_mut().commands(), self.cloths);
    }

    fn record(&self, ticks_per_second: usize) -> impl Record {
        CrowdRecord::new(ticks_per_second, self.budget)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> bunting_examples::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin(self.levels));
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        app.add_plugins(draw::control);
    }
}
