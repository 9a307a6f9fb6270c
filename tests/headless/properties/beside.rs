//! Whatever is spawned: a flag beside it goes on as it would alone.

use std::sync::OnceLock;

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bunting_tests::{Bits, app, bits, run, spawn_flag};

/// Updates in which input is looked at, levels are built, and some ticks follow.
const UPDATES: usize = 6;

/// Where the flag is, m: out of reach.
const FAR: Vec3 = Vec3::new(0.0, 1e3, 0.0);

/// A mesh of 54 vertices that becomes a grid, or a net.
pub(super) fn mesh(is_grid: bool) -> (ClothMesh, ClothResolution) {
    if is_grid {
        return (ClothMesh::grid(9, 6, 1.0, 0.6), ClothResolution::Auto);
    }
    // A trapezium: no rectangle.
    let grid =
        (0..6).flat_map(|row| (0..9).map(move |column| [column as f32 / 8.0, row as f32 / 5.0]));
    let uv: Vec<Vec2> = grid.map(Vec2::from_array).collect();
    let place = |uv: &Vec2| Vec3::new(uv.x * (1.0 - 0.3 * uv.y), -0.6 * uv.y, 0.0);
    let cells = (0..5_u32).flat_map(|row| (0..8).map(move |column| 9 * row + column));
    let corners = cells.flat_map(|at| [at, at + 9, at + 1, at + 1, at + 9, at + 10]);
    let mesh = ClothMesh::triangles(uv.iter().map(place).collect(), corners.collect(), uv);
    (mesh, ClothResolution::Particles(80))
}

/// An app in which the bits of a cloth depend on no other one.
pub(super) fn app_of_its_own() -> App {
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().share_batches = false;
    app
}

/// Runs an app with what `spawn` adds and what `change` changes later, and returns it.
///
/// # Panics
///
/// Another flag is not what it is alone, or something is not finite.
pub(super) fn flag_goes_on<Added>(
    spawn: impl FnOnce(&mut App) -> Added,
    change: impl FnOnce(&mut App, Added),
) -> App {
    static ALONE: OnceLock<Bits> = OnceLock::new();
    let alone = ALONE.get_or_init(|| beside(|_| {}, |_, ()| {}).1);
    let (mut app, flag) = beside(spawn, change);
    assert_eq!(&flag, alone, "the flag beside it");
    assert_all_finite(&mut app);
    app
}

fn beside<Added>(
    spawn: impl FnOnce(&mut App) -> Added,
    change: impl FnOnce(&mut App, Added),
) -> (App, Bits) {
    let mut app = app_of_its_own();
    let flag = spawn_flag(&mut app, FAR);
    run(&mut app, 3);
    let added = spawn(&mut app);
    run(&mut app, UPDATES);
    change(&mut app, added);
    run(&mut app, UPDATES);
    let bits = bits(&app, flag);
    (app, bits)
}

/// Panics unless all that is published of all cloths is finite.
pub(super) fn assert_all_finite(app: &mut App) {
    let world = app.world_mut();
    for (cloth, state) in world.query::<(Entity, &ClothState)>().iter(world) {
        let all = state.positions().iter().chain(state.previous_positions()).chain(state.normals());
        assert!(all.into_iter().all(|at| at.is_finite()), "{cloth} is not finite");
    }
}
