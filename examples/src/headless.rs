//! Simulates an example without a window, as fast as possible.

use std::process::ExitCode;

use bevy::app::{TaskPoolOptions, TaskPoolPlugin, TaskPoolThreadAssignmentPolicy};
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_bunting::prelude::*;
use indicatif::{ProgressBar, ProgressStyle};

use crate::{Example, Options, Record};

/// Runs one tick in each frame, however long the frame takes.
pub const ONE_TICK: TimeUpdateStrategy = TimeUpdateStrategy::FixedTimesteps(1);

/// Simulates an example and prints its measurements. Fails if a measurement exceeds its limit.
pub fn run(example: &impl Example, options: &Options) -> ExitCode {
    env_logger::Builder::new().filter_level(log::LevelFilter::Warn).init();
    let mut app = App::new();
    app.add_plugins((MinimalPlugins.set(task_pools(options)), TransformPlugin));
    start(&mut app, example);
    simulate(&mut app, example, options, |_, _| {})
}

/// The command line's number of compute threads, and Bevy's default for other threads.
#[must_use]
pub fn task_pools(options: &Options) -> TaskPoolPlugin {
    let threads = options.threads.into();
    let compute = TaskPoolThreadAssignmentPolicy {
        min_threads: threads,
        max_threads: threads,
        percent: 1.0,
        on_thread_spawn: None,
        on_thread_destroy: None,
    };
    TaskPoolPlugin { task_pool_options: TaskPoolOptions { compute, ..default() } }
}

/// Adds an example to an app that has Bevy's plugins, and finishes all plugins.
pub fn start(app: &mut App, example: &impl Example) {
    app.add_plugins(ClothPlugins::default()).insert_resource(ONE_TICK);
    example.build(app, FixedUpdate);
    app.finish();
    app.cleanup();
}

/// Simulates an example that has been started, and prints its measurements. Calls `after_tick` with
/// the simulated time in seconds. Fails if a measurement exceeds its limit.
pub fn simulate<E: Example>(
    app: &mut App,
    example: &E,
    options: &Options,
    mut after_tick: impl FnMut(&mut App, f64),
) -> ExitCode {
    let rate = app.world().resource::<Time<Fixed>>().timestep().as_secs_f64().recip();
    let ticks = (options.seconds.unwrap_or(E::SECONDS) * rate).ceil() as u64;
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {eta}");
    let progress = ProgressBar::new(ticks).with_style(style.expect("the template is valid"));
    let mut record = example.record(rate.round() as usize);
    for tick in 1..=ticks {
        app.update();
        if let Some(line) = record.add_tick(app.world_mut()) {
            progress.suspend(|| println!("{line}"));
        }
        after_tick(app, tick as f64 / rate);
        progress.inc(1);
    }
    progress.finish_and_clear();
    if record.print() {
        ExitCode::SUCCESS
    } else {
        eprintln!("a value exceeds its limit");
        ExitCode::FAILURE
    }
}
