//! Item 10: spawning many different flags.

use std::{thread, time::Duration};

use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, CostTable, LodCosts, LodReport};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_tasks::{AsyncComputeTaskPool, TaskPoolBuilder, block_on};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, greatest_speed, run, state};

/// Number of flags, all of different sizes.
const FLAGS: usize = 60;

/// Spawns flags in rows, seen from one end.
fn spawn_flags(app: &mut bevy_app::App) -> Vec<Entity> {
    let world = app.world_mut();
    world.spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 6.0)));
    world.resource_mut::<ClothBudget>().costs = LodCosts::Fixed(CostTable::default());
    world.spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)).with_gusts(2.0, 0.5, 1));
    (0..FLAGS)
        .map(|index| {
            let size = 1.5 + 0.001 * index as f32;
            let place = Vec3::new(2.0 * (index % 6) as f32 - 6.0, 0.0, -2.0 * (index / 6) as f32);
            let held = Attachment::in_place(ClothEdge::Left);
            let levels = LodSet::automatic(4);
            let mesh = ClothMesh::grid(33, 33, size, 1.0);
            world.spawn((mesh, levels, held, Transform::from_translation(place))).id()
        })
        .collect()
}

#[test]
fn different_flags_are_built_over_several_ticks() {
    let mut app = app();
    let flags = spawn_flags(&mut app);
    let mut cut = 0;
    for _ in 0..2 * FLAGS {
        app.update();
        let now = flags.iter().filter(|&&flag| !state(&app, flag).positions().is_empty()).count();
        assert!(now - cut <= 1, "{} flags of 1,089 vertices in a tick", now - cut);
        cut = now;
    }
    assert_eq!(cut, FLAGS);
}

#[test]
fn different_flags_share_batches() {
    let mut app = app();
    spawn_flags(&mut app);
    run(&mut app, 2 * FLAGS);
    let batches = app.world().resource::<ClothBatches>().batch_count();
    assert!(batches <= FLAGS / 4, "{batches} batches");
}

/// Positions of flags of these widths, m, after a second in the wind.
fn flown(widths: &[f32]) -> Vec<Vec<Vec3>> {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)));
    let flags: Vec<Entity> = widths
        .iter()
        .map(|&width| {
            let held = Attachment::in_place(ClothEdge::Left);
            app.world_mut().spawn((ClothMesh::grid(9, 9, width, 1.0), held, ClothSeed(1))).id()
        })
        .collect();
    run(&mut app, 64);
    let batches = app.world().resource::<ClothBatches>().batch_count();
    assert!(batches <= 2, "{batches} batches");
    flags.iter().map(|&flag| state(&app, flag).positions().to_vec()).collect()
}

#[test]
fn a_flag_among_different_ones_flies_as_it_does_alone() {
    let widths: Vec<f32> = (0..11).map(|index| 1.0 + 0.03 * index as f32).collect();
    let together = flown(&widths);
    for (&width, positions) in widths.iter().zip(&together) {
        assert_eq!(flown(&[width])[0], *positions, "{width} m");
    }
}

#[test]
fn cloths_begin_within_the_budget() {
    let mut app = app();
    // Substeps by need rise at once, and levels give way in the ticks after: `effort.rs`.
    let fixed = [2, 1].map(|substeps| StepSettings { passes: 2, ..StepSettings::yarns(substeps) });
    app.world_mut().resource_mut::<ClothSettings>().steps = fixed.map(StepLimits::from).into();
    let flags = spawn_flags(&mut app);
    let budget = app.world().resource::<ClothBudget>().tick;
    for tick in 0..2 * FLAGS {
        app.update();
        let report = app.world().resource::<LodReport>();
        assert!(report.expected <= budget, "{:?} in tick {tick}", report.expected);
    }
    let simulated = flags.iter().filter(|&&flag| !state(&app, flag).positions().is_empty());
    assert_eq!(simulated.count(), FLAGS);
}

#[test]
fn cloths_begin_at_their_levels() {
    let mut app = app();
    app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 200.0)));
    let held = || Attachment::in_place(ClothEdge::Left);
    let mesh = || ClothMesh::grid(33, 33, 1.5, 1.0);
    let flags: Vec<Entity> = (0..10)
        .map(|_| app.world_mut().spawn((mesh(), LodSet::automatic(4), held())).id())
        .collect();
    run(&mut app, 2);
    for flag in flags {
        assert_eq!(state(&app, flag).level(), 3);
    }
}

#[test]
fn a_cloth_can_be_simulated_in_advance() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(1.0, 0.0, 1.0)));
    let turned =
        Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(bevy_math::Quat::from_rotation_y(0.8));
    let held = || Attachment::in_place(ClothEdge::Left);
    let mut spawn = |extra: Option<ClothPreroll>| {
        let mut flag = app.world_mut().spawn((FLAG, held(), ClothSeed(1), turned));
        if let Some(preroll) = extra {
            flag.insert(preroll);
        }
        flag.id()
    };
    let (rolled, other) = (spawn(Some(ClothPreroll::seconds(2.0))), spawn(None));
    let mut first = None;
    for _ in 0..20 {
        app.update();
        if !state(&app, rolled).positions().is_empty() && first.is_none() {
            first = Some((state(&app, rolled).positions().to_vec(), greatest_speed(&app, rolled)));
        }
    }
    let (first, speed) = first.expect("it is simulated");
    assert!(first[16].y < -0.3, "as it was cut: {}", first[16]);
    assert!(speed < 5.0, "{speed} m/s");
    run(&mut app, 128 - 20);
    // The simulation in advance equals that of the other cloth.
    let apart = state(&app, other).positions()[16].distance(first[16]);
    assert!(apart < 0.2, "{apart} m");
    assert!(app.world().get::<ClothPreroll>(rolled).is_none());
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

/// Number of the update in which a cloth with a preroll is first shown, optionally while background threads
/// are busy.
fn tick_of_preroll(seconds: f32, busy: bool) -> usize {
    let mut app = app();
    let pool = AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
    let hog = || pool.spawn(async { thread::sleep(Duration::from_millis(300)) });
    let hogs: Vec<_> =
        if busy { (0..pool.thread_num()).map(|_| hog()).collect() } else { Vec::new() };
    let held = Attachment::in_place(ClothEdge::Left);
    let flag = app.world_mut().spawn((FLAG, held, ClothPreroll::seconds(seconds))).id();
    let seen = (0..200).find(|_| {
        app.update();
        !state(&app, flag).positions().is_empty()
    });
    hogs.into_iter().for_each(block_on);
    seen.expect("it is seen")
}

#[test]
fn cloths_simulated_in_advance_are_shown_in_the_same_tick_on_every_machine() {
    let tick = tick_of_preroll(60.0, false);
    assert!(tick > tick_of_preroll(0.0, false), "a minute takes longer than a tick");
    assert_eq!(tick, tick_of_preroll(60.0, true));
}
