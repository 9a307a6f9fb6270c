//! Time to save and to restore flags of 33 × 33 particles, in memory and as bytes.
//!
//! `cargo run --release --example saving_time`

use std::hint::black_box;
use std::time::{Duration, Instant};

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{app, run};

/// Flags, which fill batches.
const FLAGS: usize = 64;

/// Number of ticks before the measurement: by then the flags have lanes and histories.
const WARM_UP: usize = 30;

/// Number of times that each is measured.
const REPEATS: usize = 200;

fn main() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)).with_gusts(2.0, 0.5, 1));
    let flags: Vec<Entity> = (0..FLAGS)
        .map(|index| {
            let at = Transform::from_xyz(2.0 * index as f32, 0.0, 0.0);
            let flag = ClothMesh::grid(33, 33, 1.0, 1.0);
            app.world_mut().spawn((flag, Attachment::in_place(ClothEdge::Left), at)).id()
        })
        .collect();
    run(&mut app, WARM_UP);
    let world = app.world_mut();

    let snapshots = world.save_cloths().expect("flags");
    let one = world.save_cloth(flags[0]).expect("a flag");
    let (bytes, of_one) = (snapshots.to_bytes(), one.to_bytes());
    println!("{} bytes a flag, {} of one alone", bytes.len() / FLAGS, of_one.len());

    // A ring of eight ticks, as rollback keeps.
    let mut past = vec![snapshots.clone(); 8];
    let mut tick = 0;
    tell("save all", FLAGS, || {
        past[tick % 8] = world.save_cloths().expect("flags");
        tick += 1;
    });
    tell("save one", 1, || _ = black_box(world.save_cloth(flags[5])));
    tell("restore all", FLAGS, || world.restore_cloths(&snapshots).expect("it fits"));
    tell("restore one", 1, || world.restore_cloth(flags[0], &one).expect("it fits"));
    tell("to bytes", FLAGS, || _ = black_box(snapshots.to_bytes()));
    tell("from bytes", FLAGS, || {
        _ = black_box(ClothWorldSnapshot::from_bytes(&bytes).expect("they are whole"));
    });
}

/// Prints the median time of some work on so many flags, for each of them.
fn tell(name: &str, flags: usize, mut work: impl FnMut()) {
    let mut times: Vec<Duration> = (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed()
        })
        .collect();
    times.sort_unstable();
    let median = times[REPEATS / 2].as_secs_f64() * 1e6 / flags as f64;
    println!("{name:>12}: {median:6.1} µs a flag");
}
