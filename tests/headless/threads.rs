//! Tests of work on other threads: batches in parallel, and large cloths built in the background.

use std::sync::mpsc;

use bevy_bunting::bunting_solver::LaneCount;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_tasks::{AsyncComputeTaskPool, ComputeTaskPool, TaskPoolBuilder, block_on};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, assert_finite, bits, run, state};

use crate::thread_probe::ThreadProbe;

/// Number of threads of the compute pool if this test creates it.
const THREADS: usize = 3;

#[test]
fn threads_change_no_bit() {
    // The number of particles exceeds that of a single-threaded step.
    const CLOTHS: usize = 66;
    const MESH: ClothMesh = ClothMesh::grid(33, 33, 1.0, 1.0);
    let spawn = |app: &mut bevy_app::App, count: usize| {
        app.world_mut().resource_mut::<ClothSettings>().lanes = Some(LaneCount::One);
        let held = || Attachment::in_place(ClothEdge::Top);
        let cloths = (0..count).map(|_| app.world_mut().spawn((MESH, held())).id());
        cloths.collect::<Vec<Entity>>()
    };
    let mut lone = app();
    let one = spawn(&mut lone, 1);
    run(&mut lone, 6);
    let pool = ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(THREADS).build());
    // Another test in this process may have created the pool, with one thread for each core.
    assert!(pool.thread_num() > 1, "the pool has one thread");
    let mut many = app();
    let probe = ThreadProbe::default();
    many.world_mut().spawn((ClothCollider::new(probe.shape()), Transform::default()));
    let cloths = spawn(&mut many, CLOTHS);
    run(&mut many, 6);
    assert!(probe.count() > 1, "all batches ran on one thread");
    for cloth in cloths {
        assert_eq!(bits(&many, cloth), bits(&lone, one[0]));
    }
}

/// The only thread of the pool is blocked at first; other cloths are simulated meanwhile.
#[test]
fn a_large_cloth_is_built_in_the_background() {
    let pool = AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
    assert_eq!(pool.thread_num(), 1, "another test has created the pool");
    let (release, blocked) = mpsc::channel::<()>();
    let blocker = pool.spawn(async move { blocked.recv() });
    let mut app = app();
    let held = || Attachment::in_place(ClothEdge::Left);
    let large = app.world_mut().spawn((ClothMesh::grid(97, 97, 1.0, 1.0), held())).id();
    let small = app.world_mut().spawn((FLAG, held())).id();
    run(&mut app, 10);
    assert_finite(&app, small);
    assert!(state(&app, large).positions().is_empty(), "it was cut on the main thread");

    release.send(()).expect("the blocker waits");
    block_on(blocker).expect("it was released");
    // The thread runs tasks in their order: after this task the cloth is built.
    block_on(pool.spawn(async {}));
    run(&mut app, 2);
    assert_finite(&app, large);
    assert_eq!(state(&app, large).positions().len(), 97 * 97);
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}
