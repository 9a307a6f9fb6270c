//! What the schedule costs over plain calls of the solver: eight flags of 33 × 33, in turns.
//!
//! `cargo run --release -p bunting_tests --example schedule_overhead`

use std::sync::Arc;
use std::time::{Duration, Instant};

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
const TICKS: usize = 1000;
const WIND: Vec3 = Vec3::new(6.0, 0.0, 2.0);

fn main() {
    for settings in [StepSettings::gauss_seidel(10), StepSettings::yarns(2)] {
        println!("{settings:?}");
        measure(settings);
    }
}

fn measure(settings: StepSettings) {
    let grid = Grid::new(33, 33, 1.0, 1.0);
    let fabric = Arc::new(
        FabricBuilder::grid(grid)
            .pin_where(|_, uv| uv.x == 0.0)
            .build()
            .expect("a grid is a fabric"),
    );
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    for lane in 0..FLAGS {
        let rest = ClothSnapshot::at_rest(&fabric);
        batch.insert(&rest, FabricMaterial::default()).expect("there is room");
        batch.drive(lane, Drive { wind: WIND, ..Drive::default() });
    }

    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![settings.into()];
    app.world_mut().spawn(WindField::steady(WIND));
    for _ in 0..FLAGS {
        app.world_mut().spawn((ClothMesh::from(grid), Attachment::in_place(ClothEdge::Left)));
    }
    bunting_tests::run(&mut app, 10);
    for _ in 0..10 {
        batch.step(TICK, settings);
    }

    let (mut plain, mut copied, mut scheduled) = (Vec::new(), Vec::new(), Vec::new());
    let mut sets = vec![Vec::new(); ClothSystems::ORDER.len()];
    let mut out = vec![(Vec::new(), Vec::new()); FLAGS];
    let mut ticks = Schedule::new(ClothTick);
    core::mem::swap(
        &mut ticks,
        app.world_mut()
            .resource_mut::<Schedules>()
            .get_mut(ClothTick)
            .expect("the plugin's schedule"),
    );
    for _ in 0..TICKS {
        let began = Instant::now();
        batch.step(TICK, settings);
        plain.push(began.elapsed());
        for (lane, (positions, normals)) in out.iter_mut().enumerate() {
            batch.copy_positions(lane, positions);
            batch.copy_normals(lane, normals);
        }
        copied.push(began.elapsed());

        let began = Instant::now();
        ticks.run(app.world_mut());
        scheduled.push(began.elapsed());
        let timings = app.world().resource::<ClothTimings>();
        for (times, set) in sets.iter_mut().zip(ClothSystems::ORDER) {
            times.push(timings.of(set));
        }
    }
    let (plain, copied, scheduled) =
        (median(&mut plain), median(&mut copied), median(&mut scheduled));
    println!("plain step          {plain:9.1} µs");
    println!("plain step and copy {copied:9.1} µs");
    println!("ClothTick           {scheduled:9.1} µs");
    println!("over the step       {:8.2} %", 100.0 * (scheduled / plain - 1.0));
    println!("over step and copy  {:8.2} %", 100.0 * (scheduled / copied - 1.0));
    for (times, set) in sets.iter_mut().zip(ClothSystems::ORDER) {
        println!("  {:<17} {:9.1} µs", format!("{set:?}"), median(times));
    }
}

fn median(times: &mut [Duration]) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e6
}
