//! Item 4: equal flags in a row move differently from one another, but identically in every run.

use bevy_bunting::TickWind;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, FLAG, app, bits, run, state};

/// Distance between two flags of the row, m.
const SPACING: f32 = 3.0;

/// Nine flags in a row along the wind, spawned in the given order. Returns them in the order of the row.
fn row(order: [usize; 9], wind: WindField, ticks: usize) -> (bevy_app::App, Vec<Entity>) {
    let mut app = app();
    app.world_mut().spawn(wind);
    let mut flags = [Entity::PLACEHOLDER; 9];
    for index in order {
        let pole = Transform::from_xyz(SPACING * index as f32, 0.0, 0.0);
        let held = Attachment::in_place(ClothEdge::Left);
        flags[index] = app.world_mut().spawn((FLAG, held, pole)).id();
    }
    run(&mut app, ticks);
    (app, flags.to_vec())
}

const GUSTY: WindField = WindField::steady(Vec3::new(6.0, 0.0, 0.0)).with_gusts(2.0, 0.5, 1);

fn assert_neighbours_differ(app: &bevy_app::App, flags: &[Entity]) {
    for pair in flags.windows(2) {
        let [one, other] = [pair[0], pair[1]].map(|flag| state(app, flag).positions());
        let apart = one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(apart > 0.05, "two neighbours differ by {apart} m at most");
    }
}

#[test]
fn equal_flags_in_a_row_move_differently() {
    let (app, flags) = row([0, 1, 2, 3, 4, 5, 6, 7, 8], GUSTY, 64 * 20);
    assert_neighbours_differ(&app, &flags);
}

#[test]
fn flags_of_one_seed_meet_different_gusts() {
    let (mut app, flags) = row([0, 1, 2, 3, 4, 5, 6, 7, 8], GUSTY, 0);
    for &flag in &flags {
        app.world_mut().entity_mut(flag).insert(ClothSeed(1));
    }
    run(&mut app, 64 * 20);
    assert_neighbours_differ(&app, &flags);
}

#[test]
fn flags_differ_without_wind_too() {
    let calm = WindField::steady(Vec3::new(0.0, 0.0, 0.0));
    let (app, flags) = row([0, 1, 2, 3, 4, 5, 6, 7, 8], calm, 64 * 2);
    for pair in flags.windows(2) {
        assert_ne!(bits(&app, pair[0]), bits(&app, pair[1]));
    }
}

#[test]
fn the_order_of_spawning_changes_no_bit() {
    let all = |order| -> Vec<Bits> {
        let (app, flags) = row(order, GUSTY, 64);
        flags.iter().map(|&flag| bits(&app, flag)).collect()
    };
    assert_eq!(all([0, 1, 2, 3, 4, 5, 6, 7, 8]), all([4, 8, 1, 0, 7, 2, 3, 6, 5]));
}

#[test]
fn a_gust_is_carried_along_by_the_mean_wind() {
    let at = |x: f32, seconds: f64| {
        GUSTY.velocity_at(Vec3::new(x, 0.0, 0.0), seconds * GUSTY.travel_rate())
    };
    for tick in 0..200 {
        let seconds = f64::from(tick) / 10.0;
        let (here, there) = (at(0.0, seconds), at(12.0, seconds + 2.0));
        assert!(here.distance(there) < 1e-2, "{here} m/s, and 12 m downwind 2 s later {there}");
    }
    let differences = (0..200).map(|tick| {
        let seconds = f64::from(tick) / 10.0;
        at(0.0, seconds).distance(at(12.0, seconds))
    });
    assert!(differences.fold(0.0, f32::max) > 1.0, "it blows alike everywhere");
}

/// Greatest change of the gusts in a tick (m/s), in a wind with the given mean velocity (m/s) in each tick.
fn greatest_change(velocity: impl Fn(i32) -> Vec3) -> f32 {
    let mut app = app();
    let field = app.world_mut().spawn(GUSTY).id();
    run(&mut app, 6400);
    let mut gust = |tick: i32| {
        let mean = velocity(tick);
        app.world_mut().get_mut::<WindField>(field).unwrap().velocity = mean;
        run(&mut app, 1);
        app.world().resource::<TickWind>().at(Vec3::ZERO) - mean
    };
    let mut last = gust(0);
    let changes = (1..640).map(|tick| {
        let now = gust(tick);
        core::mem::replace(&mut last, now).distance(now)
    });
    changes.fold(0.0, f32::max)
}

#[test]
fn gusts_stay_continuous_where_the_mean_wind_changes() {
    let steady = greatest_change(|_| 6.0 * Vec3::X);
    let rising = greatest_change(|tick| (6.0 + 6.0 * (tick as f32 / 64.0).sin()) * Vec3::X);
    let veering =
        greatest_change(|tick| Quat::from_rotation_y(tick as f32 / 64.0) * (6.0 * Vec3::X));
    for (name, changing) in [("rising", rising), ("veering", veering)] {
        assert!(changing < 1.5 * steady, "{name}: {changing} m/s in a tick, {steady} if steady");
    }
}
