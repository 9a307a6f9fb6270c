//! Simulates a scene without a window.

use bevy::app::{TaskPoolOptions, TaskPoolPlugin, TaskPoolThreadAssignmentPolicy};
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::ONE_TICK;
use bunting_examples::pictures::{self, Album};
use bunting_scenes::Scene;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use crate::record::Record;
use crate::{material, stage, table};

/// How long to simulate, and on how many threads.
#[derive(Clone, Debug, Args)]
pub struct Run {
    /// Simulated time in seconds.
    #[arg(long, default_value_t = 20.0, value_parser = positive, requires = "headless")]
    seconds: f64,
    /// Threads that simulate.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..), requires = "headless")]
    threads: u16,
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("must be positive".to_owned()) }
}

/// Simulates as fast as it goes, and prints what was measured.
pub fn run(scene: &Scene, run: &Run, album: &Album) {
    let mut app = App::new();
    let mut pictures = album.open(env!("CARGO_BIN_NAME"));
    let log = LogPlugin { level: Level::WARN, ..default() };
    let threads = TaskPoolPlugin { task_pool_options: compute_threads(run.threads.into()) };
    if pictures.is_some() {
        app.add_plugins((pictures::windowless().set(threads).set(log), pictures::plugin))
            .add_plugins((stage::plugin, material::plugin));
    } else {
        app.add_plugins((MinimalPlugins.set(threads), TransformPlugin, log));
    }
    app.add_plugins(ClothPlugins::default())
        .insert_resource(ONE_TICK)
        .add_systems(FixedUpdate, bunting_scenes::follow_tracks);
    bunting_scenes::spawn(&mut app.world_mut().commands(), scene);
    app.finish();
    app.cleanup();
    if let Some(pictures) = &mut pictures {
        pictures.set_up(&mut app, stage::STAGE.camera());
    }

    let ticks_a_second =
        app.world().resource::<Time<Fixed>>().timestep().as_secs_f64().recip().round();
    let ticks = (run.seconds * ticks_a_second).ceil() as usize;
    let progress = ProgressBar::new(ticks as u64).with_style(style());
    let mut record = Record::new(scene);
    for tick in 1..=ticks {
        app.update();
        record.take_tick(app.world_mut());
        if tick % ticks_a_second as usize == 0 {
            let line = record.take_second(app.world(), ticks_a_second as usize);
            progress.suspend(|| println!("{line}"));
        }
        if let Some(pictures) = &mut pictures {
            pictures.take_due(&mut app, tick as f64 / ticks_a_second);
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    table::print(&record);
}

/// So many threads for the simulation, and what Bevy thinks best for the rest.
fn compute_threads(count: usize) -> TaskPoolOptions {
    let compute = TaskPoolThreadAssignmentPolicy {
        min_threads: count,
        max_threads: count,
        percent: 1.0,
        on_thread_spawn: None,
        on_thread_destroy: None,
    };
    TaskPoolOptions { compute, ..default() }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{bar:40} {percent:>3} % {eta}").expect("the template is good")
}
