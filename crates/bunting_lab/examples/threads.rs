//! Sixty-four flags on one thread and on two: by plain calls, by tasks of a pool, and what a pool costs by itself.
//!
//! Samples on one and on two threads alternate, so that both see the same load of the machine; the shortest of each are
//! compared.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example threads -- SAMPLES
//! ```

use std::{
    hint,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};
use bevy_tasks::{TaskPool, TaskPoolBuilder};
use bunting_lab::{
    fleet::Fleet, product::TICK, scenes::Scene, settings::steps_of_levels, timing::Timing,
};
use bunting_solver::{ClothBatch, StepSettings};

/// Flags of each size.
const FLAGS: usize = 64;
/// Length of a sample by plain calls, µs: long beside the start of both threads, short beside a slice of the scheduler.
const SAMPLE: f64 = 2_000.0;
/// Ticks before anything is measured.
const WARM_UP: usize = 60;
/// Work of a task of a pool that is measured by itself, µs.
const TASKS: [f64; 3] = [0.0, 10.0, 50.0];
/// Number of these tasks.
const TASK_COUNT: usize = 4;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [samples] = &arguments[..] else { bail!("SAMPLES") };
    let samples = samples.parse().context("SAMPLES")?;
    // As in the plugin, the calling thread works beside those of the pool.
    let pools = [1, 2, 3].map(|threads| TaskPoolBuilder::new().num_threads(threads).build());
    for work in TASKS {
        for pool in &pools {
            let time = time_of_tasks(pool, work, samples);
            println!(
                "{TASK_COUNT} tasks of {work} µs, pool of {}: {:.1} µs, median {:.1}",
                pool.thread_num(),
                time.min(),
                time.median()
            );
        }
    }
    for n in [5, 9, 17, 33] {
        let settings = steps_of_levels()[usize::from(n < 33)];
        let mut fleet = Fleet::new(Scene::flag(n), FLAGS, settings);
        fleet.advance(WARM_UP);
        let [one, two] = by_plain_calls(fleet.batches_mut(), settings, samples);
        report(n, "plain calls", &one, &two);
        for pool in &pools {
            let [one, two] = by_tasks(pool, fleet.batches_mut(), settings, samples);
            report(n, &format!("pool of {}", pool.thread_num()), &one, &two);
        }
    }
    Ok(())
}

fn report(n: usize, by: &str, one: &Timing, two: &Timing) {
    let (shortest, median) = (one.min() / two.min(), one.median() / two.median());
    println!(
        "{n} × {n}, {by}: {:.1} µs, {:.1} µs; {shortest:.2} times by the shortest, {median:.2} by medians",
        one.min(),
        two.min()
    );
}

/// Runs for a time, µs.
fn spin(work: f64) {
    let end = Instant::now() + Duration::from_secs_f64(1e-6 * work);
    while Instant::now() < end {
        hint::spin_loop();
    }
}

/// Time until tasks of a pool are done, which take `work` µs each.
fn time_of_tasks(pool: &TaskPool, work: f64, samples: usize) -> Timing {
    let mut timing = Timing::default();
    for _ in 0..samples {
        // The threads of the pool fall asleep.
        thread::sleep(Duration::from_micros(500));
        timing.time(|| {
            pool.scope(|scope| (0..TASK_COUNT).for_each(|_| scope.spawn(async move { spin(work) })))
        });
    }
    timing
}

fn tick(batches: &mut [ClothBatch], settings: StepSettings) {
    batches.iter_mut().for_each(|batch| batch.step(TICK, settings));
}

/// Times of a tick with all batches on this thread, and with the second half of them on another, which has woken up
/// before time is taken.
fn by_plain_calls(
    batches: &mut [ClothBatch],
    settings: StepSettings,
    samples: usize,
) -> [Timing; 2] {
    let once = Timing::repeat(3, 20, || tick(batches, settings)).median();
    let ticks = (SAMPLE / once).ceil() as usize;
    let mut times = [Timing::default(), Timing::default()];
    for _ in 0..samples {
        let began = Instant::now();
        (0..ticks).for_each(|_| tick(batches, settings));
        times[0].push(began.elapsed().as_secs_f64() * 1e6 / ticks as f64);
        let arrived = AtomicUsize::new(0);
        let meet = |of: usize| {
            arrived.fetch_add(1, Ordering::AcqRel);
            while arrived.load(Ordering::Acquire) < 2 * of {
                hint::spin_loop();
            }
        };
        let (first, second) = batches.split_at_mut(batches.len() / 2);
        let time = thread::scope(|scope| {
            scope.spawn(|| {
                meet(1);
                (0..ticks).for_each(|_| tick(second, settings));
                meet(2);
            });
            meet(1);
            let began = Instant::now();
            (0..ticks).for_each(|_| tick(first, settings));
            meet(2);
            began.elapsed()
        });
        times[1].push(time.as_secs_f64() * 1e6 / ticks as f64);
    }
    times
}

/// Times of a tick with all batches on this thread, and with each batch a task of a pool.
fn by_tasks(
    pool: &TaskPool,
    batches: &mut [ClothBatch],
    settings: StepSettings,
    samples: usize,
) -> [Timing; 2] {
    let mut times = [Timing::default(), Timing::default()];
    for _ in 0..samples {
        times[0].time(|| tick(batches, settings));
        times[1].time(|| {
            pool.scope(|scope| {
                for batch in &mut *batches {
                    scope.spawn(async move { batch.step(TICK, settings) });
                }
            });
        });
    }
    times
}
