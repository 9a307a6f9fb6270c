//! Flies over the plaza without a window.

use bevy::app::{TaskPoolOptions, TaskPoolPlugin};
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::ONE_TICK;
use bunting_examples::pictures::{self, Album};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use crate::plaza::{self, Crowd};
use crate::table::Record;
use crate::{colours, flight, stage};

/// How long to fly.
#[derive(Clone, Debug, Args)]
pub struct Run {
    /// Simulated time in seconds; once round by default.
    #[arg(long, default_value_t = flight::ROUND, requires = "headless")]
    seconds: f64,
}

/// Flies as fast as it goes, and prints what was measured.
pub fn run(crowd: &Crowd, run: &Run, album: &Album) {
    let mut app = App::new();
    let mut pictures = album.open(env!("CARGO_BIN_NAME"));
    let log = LogPlugin { level: Level::WARN, ..default() };
    if pictures.is_some() {
        app.add_plugins((pictures::windowless().set(log), pictures::plugin))
            .add_plugins((stage::plugin, colours::plugin));
    } else {
        // One thread, as the budget has it.
        let threads = TaskPoolPlugin { task_pool_options: TaskPoolOptions::with_num_threads(1) };
        app.add_plugins((MinimalPlugins.set(threads), TransformPlugin, log));
    }
    app.add_plugins(ClothPlugins::default()).insert_resource(ONE_TICK);
    plaza::build(&mut app, crowd);
    app.finish();
    app.cleanup();
    if let Some(pictures) = &mut pictures {
        pictures.set_up(&mut app, stage::STAGE.camera());
    }

    let rate = app.world().resource::<Time<Fixed>>().timestep().as_secs_f64().recip();
    let ticks = (run.seconds * rate).ceil() as usize;
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {eta}");
    let progress = ProgressBar::new(ticks as u64).with_style(style.expect("the template is good"));
    let mut record = Record::new(rate.round() as usize);
    for tick in 1..=ticks {
        app.update();
        record.take(app.world());
        if let Some(pictures) = &mut pictures {
            pictures.take_due(&mut app, tick as f64 / rate);
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    record.print(crowd);
}
