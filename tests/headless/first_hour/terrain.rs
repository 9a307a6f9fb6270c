//! Item 11: cloth that is spawned across terrain leaves it.

use bevy_app::App;
use bevy_bunting::parry3d::shape::{HeightField, SharedShape};
use bevy_bunting::parry3d::utils::Array2;
use bevy_bunting::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{app, run, state};

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
