//! Cloths that touch one another.

use std::f32::consts::PI;

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

use bunting_tests::{app, bits, run, state};

/// Side of the sheets, m.
const SIDE: f32 = 0.5;

/// A sheet of some columns and rows that lies level, its middle at a height above the origin, m.
fn spawn_sheet(app: &mut App, size: u32, height: f32) -> Entity {
    let at = Transform::from_xyz(-0.5 * SIDE, height, -0.5 * SIDE)
        .with_rotation(Quat::from_rotation_x(0.5 * PI));
    let material = FabricMaterial { damping: 3.0, thickness: 2e-3, ..FabricMaterial::COTTON };
    let sheet = (ClothMesh::grid(size, size, SIDE, SIDE), ClothMaterial(material), at);
    app.world_mut().spawn(sheet).id()
}

/// Median height of a sheet's particles in the world, m.
fn height(app: &App, sheet: Entity) -> f32 {
    let frame = app.world().get::<Transform>(sheet).expect("a transform");
    let mut heights: Vec<f32> =
        state(app, sheet).positions().iter().map(|&at| (*frame * at).y).collect();
    heights.sort_by(f32::total_cmp);
    heights[heights.len() / 2]
}

/// A floor, and two sheets of different meshes above it, the higher one first.
fn scene(collision: [Option<ClothCollision>; 2]) -> (App, [Entity; 2]) {
    let mut app = app();
    let floor =
        (ClothCollider::cuboid(Vec3::new(2.0, 0.5, 2.0)), Transform::from_xyz(0.0, -0.5, 0.0));
    app.world_mut().spawn(floor);
    let sheets = [spawn_sheet(&mut app, 13, 0.06), spawn_sheet(&mut app, 17, 0.01)];
    for (sheet, collision) in sheets.iter().zip(collision) {
        if let Some(collision) = collision {
            app.world_mut().entity_mut(*sheet).insert(collision);
        }
    }
    (app, sheets)
}

const BOTH: [Option<ClothCollision>; 2] = [Some(ClothCollision { thickness: 5e-3, levels: 1 }); 2];

#[test]
fn cloths_lie_on_one_another_if_both_ask_for_it_and_their_layers_touch() {
    let lies = |collision, layers: Option<ClothLayers>| {
        let (mut app, [upper, lower]) = scene(collision);
        if let Some(layers) = layers {
            app.world_mut().entity_mut(upper).insert(layers);
        }
        run(&mut app, 120);
        let apart = height(&app, upper) - height(&app, lower);
        assert!(height(&app, lower) > 1e-3, "{}", height(&app, lower));
        apart > 3e-3
    };
    assert!(lies(BOTH, None));
    assert!(lies(BOTH, Some(ClothLayers::new(2, u32::MAX))));
    assert!(!lies(BOTH, Some(ClothLayers::new(u32::MAX, 0))));
    assert!(!lies([BOTH[0], None], None));
}

#[test]
fn cloth_that_is_alone_has_the_bits_of_cloth_without_collision() {
    let fly = |collision| {
        let (mut app, [upper, lower]) = scene(collision);
        app.world_mut().entity_mut(lower).insert(Transform::from_xyz(5.0, 0.0, 0.0));
        run(&mut app, 60);
        [bits(&app, upper), bits(&app, lower)]
    };
    assert!(fly(BOTH) == fly([None, None]));
}

/// Runs until two cloths fall asleep in the same tick.
fn wait_for_rest(app: &mut App, [upper, lower]: [Entity; 2]) {
    let activity = |app: &App, sheet| state(app, sheet).activity();
    let mut ticks = 0;
    while activity(app, upper) != ClothActivity::AtRest {
        assert_eq!(activity(app, lower), ClothActivity::Ticking);
        run(app, 1);
        ticks += 1;
        assert!(ticks < 64 * 60, "the cloths do not come to rest");
    }
    assert_eq!(activity(app, lower), ClothActivity::AtRest);
}

#[test]
fn cloths_fall_asleep_together_and_wake_when_another_one_comes() {
    let (mut app, [upper, lower]) = scene(BOTH);
    let activity = |app: &App, sheet| state(app, sheet).activity();
    wait_for_rest(&mut app, [upper, lower]);
    let before = [height(&app, upper), height(&app, lower)];
    run(&mut app, 64);
    assert_eq!(activity(&app, upper), ClothActivity::AtRest);
    let third = spawn_sheet(&mut app, 17, 0.4);
    app.world_mut().entity_mut(third).insert(ClothCollision::default());
    // A new component wakes all cloths once.
    run(&mut app, 5);
    assert_eq!(activity(&app, upper), ClothActivity::Ticking);
    run(&mut app, 123);
    assert!(height(&app, third) - height(&app, upper) > 3e-3);
    assert!((height(&app, upper) - before[0]).abs() < 3e-3);
    assert!((height(&app, lower) - before[1]).abs() < 3e-3);
}

#[test]
fn cloth_without_support_wakes() {
    let (mut app, [upper, lower]) = scene(BOTH);
    wait_for_rest(&mut app, [upper, lower]);
    let before = height(&app, upper);
    app.world_mut().despawn(lower);
    run(&mut app, 64);
    assert!(height(&app, upper) < before - 3e-3);
}

/// Errors so far.
#[derive(Resource, Default)]
struct Failures(Vec<ClothError>);

#[test]
fn a_bad_thickness_is_reported_and_other_cloths_are_not_affected() {
    let bad = ClothCollision { thickness: f32::NAN, levels: 1 };
    let fall = |third: Option<ClothCollision>| {
        let (mut app, [upper, lower]) = scene(BOTH);
        app.init_resource::<Failures>();
        app.add_observer(|failed: On<ClothFailed>, mut failures: ResMut<Failures>| {
            failures.0.push(failed.error);
        });
        let entity = spawn_sheet(&mut app, 9, 0.12);
        if let Some(third) = third {
            app.world_mut().entity_mut(entity).insert(third);
        }
        run(&mut app, 60);
        let failures = app.world().resource::<Failures>().0.len();
        ([bits(&app, upper), bits(&app, lower)], failures)
    };
    let (without, none) = fall(None);
    let (with, one) = fall(Some(bad));
    assert!(without == with && none == 0 && one == 1);
}

#[test]
fn a_cloth_that_fails_leaves_the_others_finite() {
    let (mut app, [upper, lower]) = scene(BOTH);
    app.init_resource::<Failures>();
    app.add_observer(|failed: On<ClothFailed>, mut failures: ResMut<Failures>| {
        failures.0.push(failed.error);
    });
    run(&mut app, 20);
    // A speed at which the positions overflow.
    let blow = ClothImpulse::velocity(Vec3::ZERO, f32::INFINITY, f32::MAX * Vec3::X);
    app.world_mut().trigger(blow.on(upper));
    run(&mut app, 60);
    assert!(!app.world().resource::<Failures>().0.is_empty());
    assert!(state(&app, lower).positions().iter().all(|at| at.is_finite()));
    assert!(height(&app, lower) > 1e-3);
}
