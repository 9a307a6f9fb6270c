//! Tests that the bits of a cloth depend neither on other cloths, where these share no batch by taking more substeps, nor on
//! batches.

use bevy_app::prelude::*;
use bevy_bunting::bunting_solver::LaneCount;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, ClothSubstep, ClothSubstepSystems};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, FLAG, app, bits, run, spawn_flag};

/// Spawns wind, a collider, a viewer, and cloths at several levels on which all of these act.
fn spawn_scene(app: &mut App) -> Vec<Entity> {
    let world = app.world_mut();
    world.spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)).with_gusts(3.0, 0.7, 5));
    let ball = ClothCollider { features: true, ..ClothCollider::ball(0.3) };
    world.spawn((ball, Transform::from_xyz(1.0, -0.6, 0.2)));
    world.spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 12.0)));
    let mut cloths: Vec<Entity> = (0..11)
        .map(|index| {
            let levels = LodSet::new([8.0 + index as f32]);
            let place = Transform::from_xyz(0.01 * index as f32, 0.0, 0.0);
            world.spawn((FLAG, levels, Attachment::in_place(ClothEdge::Left), place)).id()
        })
        .collect();
    cloths.push(world.spawn(ClothMesh::grid(9, 9, 1.0, 1.0)).id());
    cloths
}

fn all_bits(app: &App, cloths: &[Entity]) -> Vec<Bits> {
    cloths.iter().map(|&cloth| bits(app, cloth)).collect()
}

#[test]
fn two_worlds_give_the_same_bits() {
    let run_one = || {
        let mut app = app();
        let cloths = spawn_scene(&mut app);
        run(&mut app, 120);
        all_bits(&app, &cloths)
    };
    assert_eq!(run_one(), run_one());
}

#[test]
fn the_width_of_the_lanes_changes_no_bit() {
    let run_one = |lanes: Option<LaneCount>| {
        let mut app = app();
        app.world_mut().resource_mut::<ClothSettings>().lanes = lanes;
        let cloths = spawn_scene(&mut app);
        run(&mut app, 120);
        (all_bits(&app, &cloths), app.world().resource::<ClothBatches>().batch_count())
    };
    let (scalar, batches) = run_one(Some(LaneCount::One));
    assert_eq!(batches, scalar.len(), "one cloth a batch");
    for lanes in [None, Some(LaneCount::Eight), Some(LaneCount::Sixteen)] {
        let (bits, batches) = run_one(lanes);
        assert_eq!(bits, scalar, "{lanes:?}");
        assert!(batches < scalar.len(), "{lanes:?}: {batches} batches");
    }
}

/// With a user's system in the substep, each phase runs on all batches before the next phase; without it, all
/// phases run on one batch before the next batch.
#[test]
fn a_system_in_the_substep_changes_no_bit() {
    let run_one = |with_system: bool| {
        let mut app = app();
        if with_system {
            app.add_systems(ClothSubstep, (|| {}).in_set(ClothSubstepSystems::Integrate));
        }
        let coarse = StepSettings { substeps: 1, ..StepSettings::default() };
        app.world_mut().resource_mut::<ClothSettings>().steps =
            vec![StepSettings::default().into(), coarse.into()];
        let cloths = spawn_scene(&mut app);
        run(&mut app, 120);
        all_bits(&app, &cloths)
    };
    assert_eq!(run_one(true), run_one(false));
}

#[test]
fn other_cloths_change_no_bit() {
    let mut lone = app();
    let one = spawn_flag(&mut lone, Vec3::ZERO);
    let mut many = app();
    let among = spawn_flag(&mut many, Vec3::ZERO);
    for app in [&mut lone, &mut many] {
        app.world_mut().resource_mut::<ClothSettings>().share_batches = false;
    }
    // The first update simulates no tick.
    run(&mut lone, 1);
    run(&mut many, 1);
    let mut others = Vec::new();
    for tick in 0..100 {
        // Other cloths come and go, so that the cloth moves from batch to batch.
        match tick % 10 {
            0..=4 => others.push(spawn_flag(&mut many, Vec3::X * tick as f32)),
            7 => (0..4).for_each(|_| {
                many.world_mut().despawn(others.remove(0));
            }),
            _ => {}
        }
        run(&mut lone, 1);
        run(&mut many, 1);
        assert_eq!(bits(&lone, one), bits(&many, among), "tick {tick}");
    }
}
