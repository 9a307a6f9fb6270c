//! Cost of the plugin's schedule over plain calls of the solver: eight flags of 33 × 33 particles, stepped
//! alternately by both.
//!
//! `cargo run --release --example schedule_overhead`

use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_bunting::ClothTick;
use bevy_bunting::bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, Grid, LaneCount,
};
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothSystems, ClothTimings};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_tests::{TICK, app};

const FLAGS: usize = 8;
const GRID: Grid = Grid::new(33, 33, 1.0, 1.0);

/// Wind velocity, m/s.
const WIND: Vec3 = Vec3::new(6.0, 0.0, 2.0);

/// Number of ticks before the measurement: by then the cloths have their lanes.
const WARM_UP: usize = 10;

const TICKS: usize = 1000;

fn main() {
    for settings in [StepSettings::gauss_seidel(10), StepSettings::yarns(2)] {
        println!("{settings:?}");
        measure(settings);
    }
}

fn measure(settings: StepSettings) {
    let mut batch = batch();
    (0..WARM_UP).for_each(|_| batch.step(TICK, settings));
    let mut app = app_with_flags(settings);
    bunting_tests::run(&mut app, WARM_UP);
    let mut schedule = take_schedule(&mut app);

    let [mut plain, mut copied, mut scheduled] = [const { Vec::new() }; 3];
    let mut sets = vec![Vec::new(); ClothSystems::ORDER.len()];
    let mut surfaces = vec![(Vec::new(), Vec::new()); FLAGS];
    for _ in 0..TICKS {
        let start = Instant::now();
        batch.step(TICK, settings);
        plain.push(start.elapsed());
        for (lane, (positions, normals)) in surfaces.iter_mut().enumerate() {
            batch.copy_positions(lane, positions);
            batch.copy_normals(lane, normals);
        }
        copied.push(start.elapsed());

        let start = Instant::now();
        schedule.run(app.world_mut());
        scheduled.push(start.elapsed());
        let timings = app.world().resource::<ClothTimings>();
        for (times, set) in sets.iter_mut().zip(ClothSystems::ORDER) {
            times.push(timings.of(set));
        }
    }
    let [plain, copied, scheduled] = [plain, copied, scheduled].map(median);
    println!("plain step          {plain:9.1} µs");
    println!("plain step and copy {copied:9.1} µs");
    println!("ClothTick           {scheduled:9.1} µs");
    println!("over the step       {:8.2} %", 100.0 * (scheduled / plain - 1.0));
    println!("over step and copy  {:8.2} %", 100.0 * (scheduled / copied - 1.0));
    for (times, set) in sets.into_iter().zip(ClothSystems::ORDER) {
        println!("  {:<17} {:9.1} µs", format!("{set:?}"), median(times));
    }
}

/// The flags in a batch of the solver.
fn batch() -> ClothBatch {
    let builder = FabricBuilder::grid(GRID).pin_where(|_, uv| uv.x == 0.0);
    let fabric = Arc::new(builder.build().expect("a grid is a fabric"));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    for lane in 0..FLAGS {
        let rest = ClothSnapshot::at_rest(&fabric);
        batch.insert(&rest, FabricMaterial::default()).expect("a lane is free");
        batch.drive(lane, Drive { wind: WIND, ..Drive::default() }).expect("a good drive");
    }
    batch
}

/// The flags in an app.
fn app_with_flags(settings: StepSettings) -> App {
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![settings.into()];
    app.world_mut().spawn(WindField::steady(WIND));
    for _ in 0..FLAGS {
        app.world_mut().spawn((ClothMesh::from(GRID), Attachment::in_place(ClothEdge::Left)));
    }
    app
}

/// Removes the tick's schedule from an app, to run it without the rest of a frame.
fn take_schedule(app: &mut App) -> Schedule {
    let mut schedules = app.world_mut().resource_mut::<Schedules>();
    schedules.remove(ClothTick).expect("the plugin adds it")
}

/// Median of durations, µs.
fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e6
}
