//! Tests that the sets run in the documented order.

use bevy_app::prelude::*;
use bevy_bunting::prelude::{Attachment, ClothEdge, ClothMesh, LodSet, StepSettings};
use bevy_bunting::{ClothSettings, ClothSubstep, ClothSubstepSystems, ClothSystems, ClothTick};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{IntoScheduleConfigs, ScheduleLabel, SystemSet};
use bevy_math::Vec3;
use bevy_time::{Fixed, Time};
use bunting_tests::{app, run, spawn_flag};

/// The sets of a substep in the documented order.
const SUBSTEP: [&str; 5] =
    ["Integrate", "UserForces", "SolveConstraints", "UserConstraints", "UpdateVelocities"];

#[derive(Resource, Default)]
struct Log(Vec<String>);

/// Adds a system that logs the name of its set and is ordered only by this set.
fn probe(app: &mut App, schedule: impl ScheduleLabel, set: impl SystemSet + Clone) {
    let name = format!("{set:?}");
    app.add_systems(schedule, (move |mut log: ResMut<Log>| log.0.push(name.clone())).in_set(set));
}

fn probed() -> App {
    let mut app = app();
    app.init_resource::<Log>();
    for set in ClothSystems::ORDER {
        probe(&mut app, ClothTick, set);
    }
    for set in ClothSubstepSystems::ORDER.into_iter().rev() {
        probe(&mut app, ClothSubstep, set);
    }
    app
}

#[test]
fn sets_run_in_order() {
    let mut app = probed();
    spawn_flag(&mut app, Vec3::ZERO);
    app.world_mut().resource_mut::<ClothSettings>().steps =
        vec![StepSettings { substeps: 3, ..StepSettings::default() }.into()];
    run(&mut app, 2);
    let log = core::mem::take(&mut app.world_mut().resource_mut::<Log>().0);

    let tick: Vec<&str> = log.iter().map(String::as_str).filter(|set| !is_substep(set)).collect();
    assert_eq!(tick.len() % 6, 0);
    assert!(!tick.is_empty());
    for sets in tick.chunks(6) {
        assert_eq!(sets, ["Prepare", "SelectLod", "Drive", "Step", "Normals", "Publish"]);
    }
    let substeps: Vec<&str> =
        log.iter().map(String::as_str).filter(|set| is_substep(set)).collect();
    assert_eq!(substeps.len() / 5, 3 * tick.len() / 6, "three substeps a tick");
    for sets in substeps.chunks(5) {
        assert_eq!(sets, SUBSTEP);
    }
    // Substeps run within Step: between Drive and Normals.
    let first = log.iter().position(|set| is_substep(set)).expect("substeps");
    let drive = log.iter().position(|set| set == "Drive").expect("a tick");
    let normals = log.iter().position(|set| set == "Normals").expect("a tick");
    assert!(drive < first && first < normals);
}

#[test]
fn the_finest_level_sets_the_number_of_substeps() {
    let mut app = probed();
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![
        StepSettings { substeps: 6, ..StepSettings::default() }.into(),
        StepSettings { substeps: 2, ..StepSettings::default() }.into(),
    ];
    let coarse = (ClothMesh::grid(5, 5, 1.0, 1.0), LodSet::new([10.0]).pinned_to(1));
    app.world_mut().spawn(coarse);
    run(&mut app, 2);
    assert_eq!(substeps(&mut app), 2);
    spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 1);
    assert_eq!(substeps(&mut app), 6);
}

#[test]
fn fine_cloth_and_long_ticks_take_more_substeps() {
    let mut app = probed();
    let fine = (ClothMesh::grid(65, 65, 1.0, 1.0), Attachment::in_place(ClothEdge::Top));
    app.world_mut().spawn(fine);
    run(&mut app, 2);
    assert_eq!(substeps(&mut app), 4);
    app.world_mut().resource_mut::<Time<Fixed>>().set_timestep_hz(30.0);
    run(&mut app, 8);
    substeps(&mut app);
    run(&mut app, 8);
    assert_eq!(substeps(&mut app), 8);
}

/// Number of substeps in a tick since the last call.
fn substeps(app: &mut App) -> usize {
    let log = core::mem::take(&mut app.world_mut().resource_mut::<Log>().0);
    let ticks = log.iter().filter(|set| *set == "Step").count();
    log.iter().filter(|set| *set == "Integrate").count() / ticks
}

fn is_substep(set: &str) -> bool {
    SUBSTEP.contains(&set)
}
