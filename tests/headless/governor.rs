//! Tests of levels chosen within a budget, and of cloth out of view.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, CostTable, LodCosts, LodReport};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, Seen, app, assert_finite, bits, run, state};

/// Number of ticks in which a cloth can change its level twice, or fall asleep.
const A_WHILE: usize = 80;

fn spawn(app: &mut App, lods: LodSet, at: Vec3) -> Entity {
    let attachment = Attachment::in_place(ClothEdge::Left);
    let place = Transform::from_translation(at);
    app.world_mut().spawn((ClothMesh::grid(33, 33, 1.0, 1.0), attachment, lods, place)).id()
}

/// An app with fixed costs, a viewer that looks along −z, and wind in which no cloth comes to rest.
fn windy() -> (App, Entity) {
    let mut app = app();
    let wind = WindField::steady(Vec3::new(4.0, 0.0, 1.0)).with_gusts(2.0, 0.7, 5);
    app.world_mut().spawn(wind);
    let viewer = app.world_mut().spawn((LodViewer::default(), Transform::default())).id();
    set_budget(&mut app, 1000);
    (app, viewer)
}

fn set_budget(app: &mut App, microseconds: u64) {
    let mut budget = app.world_mut().resource_mut::<ClothBudget>();
    budget.tick = Duration::from_micros(microseconds);
    budget.costs = LodCosts::Fixed(CostTable::default());
}

fn set_pose(app: &mut App, entity: Entity, pose: Transform) {
    *app.world_mut().get_mut(entity).expect("a transform") = pose;
}

fn report(app: &App) -> &LodReport {
    app.world().resource()
}

#[test]
fn levels_follow_the_error_in_pixels() {
    let (mut app, viewer) = windy();
    let cloth = spawn(&mut app, LodSet::automatic(4), Vec3::ZERO);
    let biased = spawn(&mut app, LodSet::automatic(4).with_bias(4.0), Vec3::ZERO);
    let pinned = spawn(&mut app, LodSet::automatic(4).pinned_to(2), Vec3::ZERO);
    let mut away = |distance: f32| {
        set_pose(&mut app, viewer, Transform::from_xyz(0.5, -0.5, distance));
        run(&mut app, A_WHILE);
        assert_finite(&app, cloth);
        [cloth, biased, pinned].map(|cloth| state(&app, cloth).level())
    };
    // The error is a quarter of the distance between particles: 7.8 mm at the finest level, doubled at each
    // coarser one. At a distance of 1 m, 1 m is 935 px.
    assert_eq!(away(5.0), [0, 0, 2]);
    assert_eq!(away(40.0), [1, 0, 2]);
    assert_eq!(away(70.0), [2, 0, 2]);
    assert_eq!(away(140.0), [3, 1, 2]);
    assert_eq!(away(12.0), [0, 0, 2]);
}

#[test]
fn all_cloths_together_stay_within_the_budget() {
    let (mut app, viewer) = windy();
    set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, 6.0));
    let cloths: Vec<Entity> = (0..40)
        .map(|index| spawn(&mut app, LodSet::automatic(4), Vec3::X * (0.1 * index as f32 - 2.0)))
        .collect();
    let particles = |app: &App| -> usize {
        cloths.iter().map(|&cloth| state(app, cloth).positions().len()).sum()
    };
    let mut last = 0;
    for budget in [150, 400, 1000, 3000] {
        set_budget(&mut app, budget);
        run(&mut app, 3 * A_WHILE);
        assert!(report(&app).expected <= Duration::from_micros(budget), "{:?}", report(&app));
        assert!(particles(&app) > last, "a larger budget, finer cloth: {budget} µs");
        last = particles(&app);
        assert_eq!(report(&app).held_back > 0, budget < 3000);
    }
    set_budget(&mut app, 400);
    run(&mut app, 3 * A_WHILE);
    assert!(report(&app).expected <= Duration::from_micros(400));
}

#[test]
fn where_there_is_no_time_for_all_cloths_the_smallest_are_held_still() {
    let (mut app, viewer) = windy();
    set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, 20.0));
    let distance = |index: usize| 2.0 * (index % 20) as f32;
    let cloths: Vec<Entity> = (0..40)
        .map(|index| {
            let place = Transform::from_xyz(0.0, 0.0, -distance(index));
            let attachment = Attachment::in_place(ClothEdge::Left);
            let mesh = ClothMesh::grid(33, 33, 1.0 + 0.01 * index as f32, 1.0);
            app.world_mut().spawn((mesh, attachment, LodSet::automatic(3), place)).id()
        })
        .collect();
    let activities = |app: &App| -> Vec<ClothActivity> {
        cloths.iter().map(|&cloth| state(app, cloth).activity()).collect()
    };
    set_budget(&mut app, 90);
    run(&mut app, 3 * A_WHILE);
    let now = activities(&app);
    let still =
        |now: &[ClothActivity]| now.iter().filter(|it| **it == ClothActivity::OverBudget).count();
    assert!((10..30).contains(&still(&now)), "{now:?}");
    assert!(report(&app).expected <= Duration::from_micros(90), "{:?}", report(&app));
    assert_eq!((report(&app).over_budget, report(&app).asleep()), (still(&now), still(&now)));
    assert!(report(&app).held_back >= still(&now));
    let mut nearest = (0..40).filter(|&index| distance(index) < 8.0);
    assert!(nearest.all(|index| now[index] == ClothActivity::Ticking), "{now:?}");
    let held = |index: &usize| now[*index] == ClothActivity::OverBudget;
    let last = (0..40).find(held).expect("one that is still");
    let shape = bits(&app, cloths[last]);
    run(&mut app, 1);
    assert_eq!(bits(&app, cloths[last]), shape);
    assert_eq!(report(&app).switches, 0, "they take no turns");

    // The radius of a cloth 48 m from the viewer.
    app.world_mut().resource_mut::<ClothBudget>().still_below = 15.0;
    run(&mut app, A_WHILE);
    let fewer = activities(&app);
    assert!((1..still(&now)).contains(&still(&fewer)), "{fewer:?}");
    assert!(report(&app).expected > Duration::from_micros(90), "{:?}", report(&app));

    set_budget(&mut app, 3000);
    run(&mut app, A_WHILE);
    assert_eq!(still(&activities(&app)), 0);
    cloths.iter().for_each(|&cloth| assert_finite(&app, cloth));
}

#[test]
fn level_changes_are_events_and_few_in_a_tick() {
    let (mut app, viewer) = windy();
    set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, 200.0));
    let cloths: Vec<Entity> =
        (0..20).map(|_| spawn(&mut app, LodSet::automatic(4), Vec3::ZERO)).collect();
    run(&mut app, A_WHILE);
    set_budget(&mut app, 100_000);
    set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, 4.0));
    let events = |app: &App| app.world().resource::<Seen<ClothLevelChanged>>().0.len();
    let mut before = events(&app);
    for _ in 0..A_WHILE {
        run(&mut app, 1);
        let changes = events(&app) - before;
        assert_eq!(changes, report(&app).switches);
        assert!(changes <= app.world().resource::<ClothBudget>().switches);
        before += changes;
    }
    for cloth in cloths {
        assert_eq!(state(&app, cloth).level(), 0);
    }
}

#[test]
fn with_fixed_costs_two_worlds_give_the_same_bits() {
    let run_one = || {
        let (mut app, viewer) = windy();
        set_budget(&mut app, 300);
        let cloths: Vec<Entity> = (0..30)
            .map(|index| spawn(&mut app, LodSet::automatic(4), Vec3::Z * -(index as f32)))
            .collect();
        for tick in 0..120 {
            set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, 10.0 - 0.2 * tick as f32));
            run(&mut app, 1);
        }
        cloths.iter().map(|&cloth| bits(&app, cloth)).collect::<Vec<Bits>>()
    };
    assert_eq!(run_one(), run_one());
}

#[test]
fn cloth_out_of_view_sleeps_and_costs_nothing() {
    let (mut app, viewer) = windy();
    let cloth = spawn(&mut app, LodSet::automatic(4), Vec3::ZERO);
    let seen = Transform::from_xyz(0.0, 0.0, 5.0);
    let asleep = |app: &App| (state(app, cloth).activity(), report(app).asleep());
    let batches = |app: &App| app.world().resource::<ClothBatches>().batch_count();
    for (pose, range, activity) in [
        (seen.looking_to(Vec3::Z, Vec3::Y), f32::INFINITY, ClothActivity::OffScreen),
        (Transform::from_xyz(0.0, 0.0, 50.0), 20.0, ClothActivity::OutOfRange),
    ] {
        set_pose(&mut app, viewer, seen);
        run(&mut app, A_WHILE);
        assert_eq!(asleep(&app), (ClothActivity::Ticking, 0));
        assert_eq!(batches(&app), 1);
        set_pose(&mut app, viewer, pose);
        app.world_mut().get_mut::<LodViewer>(viewer).expect("a viewer").range = range;
        run(&mut app, A_WHILE);
        assert_eq!(asleep(&app), (activity, 1));
        assert_eq!(batches(&app), 0);
        let shape = bits(&app, cloth);
        run(&mut app, 10);
        assert_eq!(bits(&app, cloth), shape);
        assert_eq!(state(&app, cloth).previous_positions(), state(&app, cloth).positions());

        // In view again, the cloth begins at the coarsest level and soon is as fine as needed.
        set_pose(&mut app, viewer, seen);
        run(&mut app, 6);
        let last = app.world().resource::<Seen<ClothLevelChanged>>().0.clone();
        assert!(last.iter().any(|change| change.to == 3), "{last:?}");
        run(&mut app, A_WHILE);
        assert_eq!(state(&app, cloth).level(), 0);
        assert_finite(&app, cloth);
    }
}

#[test]
fn levels_by_distance_do_not_sleep() {
    let (mut app, viewer) = windy();
    let cloth = spawn(&mut app, LodSet::new([10.0]), Vec3::ZERO);
    set_pose(&mut app, viewer, Transform::from_xyz(0.0, 0.0, -50.0));
    run(&mut app, A_WHILE);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::Ticking);
    assert_eq!(state(&app, cloth).level(), 1);
}
