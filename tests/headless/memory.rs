//! Tests that nothing is kept for cloths that are gone.

use std::sync::{Arc, Weak};

use bevy_app::App;
use bevy_bunting::ClothBatches;
use bevy_bunting::bunting_solver::Fabric;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, assert_finite, run, spawn_flag, state};

/// Ticks after which what nothing needs is released.
const RELEASED: usize = 65;

/// Ticks after which batches that are not needed are dropped: ten seconds.
const DROPPED: usize = 640;

/// Spawns a cloth of a width of its own at each of its levels in turn. Returns it and its fabrics.
fn spawn_levels(app: &mut App, columns: u32, width: f32) -> (Entity, Vec<Weak<Fabric>>) {
    let mesh = ClothMesh::grid(columns, 9, width, 1.0);
    let held = Attachment::in_place(ClothEdge::Left);
    let levels = |level: usize| LodSet::new([20.0, 40.0]).pinned_to(level);
    let cloth = app.world_mut().spawn((mesh, held, levels(0))).id();
    let fabrics = (0..3).map(|level| {
        app.world_mut().entity_mut(cloth).insert(levels(level));
        run(app, 2);
        Arc::downgrade(state(app, cloth).fabric().expect("it is simulated"))
    });
    let fabrics = fabrics.collect();
    (cloth, fabrics)
}

fn living(fabrics: &[Weak<Fabric>]) -> usize {
    fabrics.iter().filter(|fabric| fabric.strong_count() > 0).count()
}

#[test]
fn fabrics_of_despawned_cloths_are_released() {
    let mut app = app();
    let stays = spawn_levels(&mut app, 9, 2.0);
    let mut fabrics = Vec::new();
    for round in 0..3 {
        // Grids of one topology, which share batches, and others.
        let sizes = (0..6).map(|size| (if size < 4 { 9 } else { 9 + 4 * size }, size));
        let widths =
            sizes.map(|(columns, size)| (columns, 1.0 + 0.01 * (10 * round + size) as f32));
        let cloths: Vec<_> =
            widths.map(|(columns, width)| spawn_levels(&mut app, columns, width)).collect();
        run(&mut app, 10);
        for (cloth, of_cloth) in cloths {
            assert_eq!(living(&of_cloth), 3);
            fabrics.extend(of_cloth);
            app.world_mut().despawn(cloth);
        }
    }
    run(&mut app, RELEASED);
    assert_eq!(living(&fabrics), 0, "of {} fabrics", fabrics.len());
    assert_eq!(living(&stays.1), 3);
    assert_finite(&app, stays.0);
    app.world_mut().despawn(stays.0);
    run(&mut app, RELEASED);
    assert_eq!(living(&stays.1), 0);
    assert_eq!(app.world().resource::<ClothBatches>().spare_count(), 0);
    // And cloth can come back.
    let (again, _) = spawn_levels(&mut app, 9, 2.0);
    run(&mut app, RELEASED);
    assert_finite(&app, again);
}

#[test]
fn fabrics_that_a_cloth_no_longer_has_are_released_whoever_looked_at_them() {
    let mut app = app();
    let world = app.world_mut();
    let (pole, hand) = (world.spawn(Transform::default()).id(), world.spawn_empty().id());
    let anchor = |edge: ClothEdge| Anchor::new(pole, edge);
    let held = Attachment::in_place(ClothEdge::Left)
        .with_anchor(anchor(ClothEdge::Right))
        .with_anchor(anchor(ClothEdge::Bottom).with_stiffness(100.0));
    let cloth = world.spawn((FLAG, held, AnchorReactions::default())).id();
    let near = GrabbedVertices::List(vec![12, 13]);
    world.entity_mut(hand).insert((ClothGrab::new(cloth, near), Transform::default()));
    run(&mut app, 5);
    let fabric = Arc::downgrade(state(&app, cloth).fabric().expect("it is simulated"));
    app.world_mut().entity_mut(cloth).remove::<ClothMesh>();
    run(&mut app, RELEASED);
    assert_eq!(fabric.strong_count(), 0);
}

#[test]
fn batches_that_many_cloths_have_left_are_not_kept_for_ever() {
    let mut app = app();
    let flags: Vec<Entity> = (0..50).map(|_| spawn_flag(&mut app, Vec3::ZERO)).collect();
    run(&mut app, 5);
    let spares = |app: &App| app.world().resource::<ClothBatches>().spare_count();
    for &flag in &flags[1..] {
        app.world_mut().despawn(flag);
        run(&mut app, 1);
    }
    assert!(spares(&app) > 0, "cloths that come back soon find their batches");
    run(&mut app, DROPPED);
    assert_eq!(spares(&app), 0);
    assert_finite(&app, flags[0]);
}
