//! Item 1: a distant shape costs nothing. Item 11: cloth that is spawned across terrain leaves it.

use std::time::Duration;

use bevy_app::App;
use bevy_bunting::parry3d::glamx::Pose3;
use bevy_bunting::parry3d::shape::{HeightField, SharedShape};
use bevy_bunting::parry3d::utils::Array2;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothTimings, parry3d};
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{app, run, spawn_flag, state};
use parry3d::shape::TriMesh;

/// Time that a distant shape may add to a tick, s. In an optimised build a query of each triangle of the
/// smallest bowl takes 370 ms, and a query of each particle 1 ms.
const FAR_COST: Duration = Duration::from_micros(50);

/// Height of a bowl at a distance from its middle, m: it rises by the square of the distance, one metre at 20
/// m.
fn bowl(x: f32, z: f32) -> f32 {
    (x * x + z * z) / 400.0
}

/// A bowl of 200 m with the given number of cells a side.
fn field(cells: usize) -> HeightField {
    let at = |index: usize| 200.0 * (index as f32 / cells as f32 - 0.5);
    let mut heights = Array2::zeros(cells + 1, cells + 1);
    for row in 0..=cells {
        for column in 0..=cells {
            heights[(row, column)] = bowl(at(column), at(row));
        }
    }
    HeightField::new(heights, Vec3::new(200.0, 1.0, 200.0))
}

fn mesh(cells: usize) -> SharedShape {
    let (points, triangles) = field(cells).to_trimesh();
    SharedShape::new(TriMesh::new(points, triangles).expect("a mesh"))
}

/// A hundred boxes in a ring around the flag.
fn ring() -> SharedShape {
    let boxes = (0..100).map(|index| {
        let turn = Quat::from_rotation_y(index as f32 / 100.0 * core::f32::consts::TAU);
        let place = Pose3::from_parts(turn * Vec3::new(20.0, 5.0, 0.0), turn);
        (place, SharedShape::cuboid(0.5, 5.0, 0.5))
    });
    SharedShape::compound(boxes.collect())
}

/// A flag 5 m above the origin in a wind.
fn windy(shape: Option<SharedShape>) -> App {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 1.0)));
    spawn_flag(&mut app, Vec3::new(0.0, 5.0, 0.0));
    if let Some(shape) = shape {
        app.world_mut().spawn((ClothCollider::new(shape), Transform::default()));
    }
    run(&mut app, 5);
    app
}

/// Shortest of many ticks with a shape and without, in turn, so that other work on the machine slows both.
fn shortest_ticks(shape: SharedShape) -> [Duration; 2] {
    let mut apps = [Some(shape), None].map(windy);
    let mut shortest = [Duration::MAX; 2];
    for _ in 0..100 {
        for (app, shortest) in apps.iter_mut().zip(&mut shortest) {
            app.update();
            *shortest = app.world().resource::<ClothTimings>().total().min(*shortest);
        }
    }
    shortest
}

#[test]
fn a_shape_costs_nothing_where_nothing_is_near_it() {
    let field = |cells| SharedShape::new(field(cells));
    for (name, shape) in [
        ("heightfield 16²", field(16)),
        ("heightfield 64²", field(64)),
        ("heightfield 256²", field(256)),
        ("mesh", mesh(64)),
        ("compound", ring()),
    ] {
        let [with, without] = shortest_ticks(shape);
        assert!(with < without + FAR_COST, "{name}: {with:?} a tick, {without:?} without");
    }
}

/// A sheet 2 m wide, flat or upright, half below the bottom of a bowl.
fn spawned_across(app: &mut App, flat: bool) -> bevy_ecs::entity::Entity {
    let turn = if flat { Quat::from_rotation_x(-1.3) } else { Quat::IDENTITY };
    let place = turn * Vec3::new(-1.0, 1.0, 0.0);
    let place = Transform::from_translation(place).with_rotation(turn);
    app.world_mut().spawn((ClothMesh::grid(17, 17, 2.0, 2.0), place)).id()
}

#[test]
fn cloth_that_is_spawned_across_terrain_comes_out_of_it() {
    for (name, flat) in [("flat", true), ("upright", false)] {
        let mut app = app();
        let ground = ClothCollider::new(SharedShape::new(field(64)));
        app.world_mut().spawn((ground, Transform::default()));
        let sheet = spawned_across(&mut app, flat);
        run(&mut app, 128);
        let placed = *app.world().get::<GlobalTransform>(sheet).expect("placed");
        let places = state(&app, sheet).positions().iter().map(|&at| placed.transform_point(at));
        let depth = places.map(|at| bowl(at.x, at.z) - at.y).fold(f32::MIN, f32::max);
        assert!(depth < 0.02, "{name}: {depth} m under ground");
    }
}
