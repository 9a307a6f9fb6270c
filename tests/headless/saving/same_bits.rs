//! Cloth goes on with the same bits after it is restored, in the same app and in another.

use bevy_bunting::prelude::*;
use bevy_ecs::entity::MapEntities;
use bevy_ecs::prelude::*;
use bunting_tests::{run, state};

use super::app_with_ids::{AppWithIds, Trace};
use super::scenes;

/// Ticks that are compared after each restoration.
const COMPARED: usize = 60;

/// Saves a scene after a number of updates, and compares how it goes on with how it goes on after it is restored.
fn goes_on(build: fn(&mut AppWithIds) -> Vec<Entity>, updates: usize) -> Trace {
    let mut app = AppWithIds::new(0);
    let cloths = build(&mut app);
    run(&mut app, updates);
    let others = app.others();
    let snapshot = app.world().save_cloths().expect("it can be saved");
    let expected = app.trace(&cloths, COMPARED);

    app.restore_others(&others);
    app.world_mut().restore_cloths(&snapshot).expect("it fits");
    let again = app.trace(&cloths, COMPARED);
    assert_eq!(again.first_difference(&expected), None, "in the same app");

    let bytes = snapshot.to_bytes();
    for updates in [0, 1, 40] {
        let mut other = AppWithIds::new(5);
        build(&mut other);
        run(&mut other, updates);
        other.restore_others(&others);
        let mut snapshot = ClothWorldSnapshot::from_bytes(&bytes).expect("they are whole");
        let mut entities = other.entities_for(&app);
        snapshot.map_entities(&mut entities);
        other.world_mut().restore_cloths(&snapshot).expect("it fits");
        if updates == 0 {
            // The first update has no tick.
            run(&mut other, 1);
        }
        let cloths: Vec<Entity> = cloths.iter().map(|cloth| entities[cloth]).collect();
        let there = other.trace(&cloths, COMPARED);
        assert_eq!(
            there.first_difference(&expected),
            None,
            "in another app, after {updates} updates"
        );
    }
    expected
}

#[test]
fn with_moving_targets() {
    goes_on(scenes::moving_targets, 50);
}

#[test]
fn in_gusts() {
    goes_on(scenes::gusts, 50);
}

#[test]
fn on_colliders() {
    assert!(goes_on(scenes::colliders, 45).touches());
}

#[test]
fn with_skins() {
    goes_on(scenes::skins, 50);
}

#[test]
fn held_still_for_want_of_time() {
    for updates in [30, 50, 70] {
        let trace = goes_on(scenes::little_time, updates);
        assert!(trace.has(ClothActivity::OverBudget) && trace.has(ClothActivity::Ticking));
    }
}

#[test]
fn with_levels() {
    for updates in [30, 50, 70] {
        let levels = goes_on(scenes::levels, updates).levels();
        assert!(levels.len() > 1, "{levels:?}");
    }
}

#[test]
fn in_layers() {
    goes_on(scenes::layers, 40);
}

#[test]
fn with_anchors() {
    goes_on(scenes::anchors, 50);
}

/// The first update after which a cloth of a scene is at rest.
fn comes_to_rest(build: fn(&mut AppWithIds) -> Vec<Entity>, cloth: usize) -> usize {
    let mut app = AppWithIds::new(0);
    let cloth = build(&mut app)[cloth];
    let rests = |app: &AppWithIds| state(app, cloth).activity() == ClothActivity::AtRest;
    let updates = (1..2000).find(|_| {
        run(&mut app, 1);
        rests(&app)
    });
    updates.expect("it comes to rest")
}

#[test]
fn at_rest() {
    let [first, second] = [0, 1].map(|cloth| comes_to_rest(scenes::rest, cloth));
    assert_ne!(first, second);
    // Before one of them falls asleep, just after that, and before the third one is woken by its pole.
    let woken = scenes::POLE_MOVES as usize;
    for updates in [first - 20, second - 1, second, second + 1, woken - 20] {
        let trace = goes_on(scenes::rest, updates);
        assert!(trace.has(ClothActivity::AtRest), "after {updates} updates");
        let changes = [first - 20, woken - 20].contains(&updates);
        assert!(!changes || trace.has(ClothActivity::Ticking), "after {updates} updates");
    }
}
