//! Layers, reactions, features and meshes: what cloth touches, and what it does to what it touches.

use std::f32::consts::PI;

use bevy_app::App;
use bevy_bunting::{
    ClothActivity, ClothCollider, ClothFeatures, ClothLayers, ClothMaterial, ClothMesh,
    ClothParted, ClothReactions, ClothTouched, ColliderError, SelfCollision,
};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

use bunting_tests::{app, run, state};

/// Side of the sheets, m.
const SIDE: f32 = 0.5;

/// A sheet that lies level, its middle at a height above the origin, m.
fn spawn_sheet(app: &mut App, height: f32) -> Entity {
    let at = Transform::from_xyz(-0.5 * SIDE, height, -0.5 * SIDE)
        .with_rotation(Quat::from_rotation_x(-0.5 * PI));
    app.world_mut().spawn((ClothMesh::grid(17, 17, SIDE, SIDE), at)).id()
}

/// Heights of a sheet's particles in the world, m.
fn heights(app: &App, sheet: Entity, height: f32) -> Vec<f32> {
    let turn = Quat::from_rotation_x(-0.5 * PI);
    state(app, sheet).positions().iter().map(|&at| height + (turn * at).y).collect()
}

fn lowest(app: &App, sheet: Entity, height: f32) -> f32 {
    heights(app, sheet, height).into_iter().fold(f32::MAX, f32::min)
}

/// A floor whose upper face is at the origin.
fn floor() -> (ClothCollider, Transform) {
    (ClothCollider::cuboid(Vec3::new(2.0, 0.5, 2.0)), Transform::from_xyz(0.0, -0.5, 0.0))
}

#[test]
fn cloth_touches_the_layers_of_its_filters() {
    let falls = |of_cloth: Option<ClothLayers>, of_floor: Option<ClothLayers>| {
        let mut app = app();
        let sheet = spawn_sheet(&mut app, 0.2);
        let floor = app.world_mut().spawn(floor()).id();
        for (entity, layers) in [(sheet, of_cloth), (floor, of_floor)] {
            if let Some(layers) = layers {
                app.world_mut().entity_mut(entity).insert(layers);
            }
        }
        run(&mut app, 60);
        lowest(&app, sheet, 0.2) < -0.5
    };
    let layers = ClothLayers::new;
    for (of_cloth, of_floor, touch) in [
        (None, None, true),
        (Some(ClothLayers::default()), None, true),
        (Some(layers(1, 2)), Some(layers(2, 1)), true),
        (Some(layers(1, 2)), Some(layers(2, 2)), false),
        (Some(layers(1, 4)), Some(layers(2, 1)), false),
        (None, Some(layers(0, u32::MAX)), false),
    ] {
        assert_eq!(falls(of_cloth, of_floor), !touch, "{of_cloth:?} {of_floor:?}");
    }
}

/// Colliders and cloths of the events so far, in their order: begun, ceased.
#[derive(Resource, Default)]
struct Seen(Vec<(bool, Entity, Entity)>);

#[test]
fn a_floor_feels_the_weight_of_a_sheet() {
    let mut app = app();
    app.init_resource::<Seen>();
    app.add_observer(|event: On<ClothTouched>, mut seen: ResMut<Seen>| {
        seen.0.push((true, event.entity, event.cloth));
    });
    app.add_observer(|event: On<ClothParted>, mut seen: ResMut<Seen>| {
        seen.0.push((false, event.entity, event.cloth));
    });
    let sheet = spawn_sheet(&mut app, 0.1);
    let material = app.world().get::<ClothMaterial>(sheet).expect("a material").0;
    // The floor is turned and beside the sheet's middle, so that axes and the arm of the torque matter.
    let (collider, mut at) = floor();
    at.rotate_y(0.7);
    at.translation.x = 0.25;
    let floor = app.world_mut().spawn((collider, at, ClothReactions::default())).id();
    app.world_mut().spawn((ClothCollider::ball(0.1), Transform::from_xyz(9.0, 0.0, 0.0)));
    run(&mut app, 2);
    assert!(app.world().resource::<Seen>().0.is_empty());
    run(&mut app, 60);
    let weight = material.area_density * SIDE * SIDE * 9.81;
    let of = |app: &App| app.world().get::<ClothReactions>(floor).expect("reactions").clone();
    for ticks in [1, 200] {
        run(&mut app, ticks);
        let reactions = of(&app);
        let off = reactions.force - weight * Vec3::NEG_Y;
        assert!(off.length() < 0.01 * weight, "{reactions:?} for {weight} N after {ticks}");
        // The sheet lies a quarter of a metre beside the floor's middle.
        let torque = Vec3::new(-0.25, 0.0, 0.0).cross(weight * Vec3::NEG_Y);
        let off = reactions.torque - torque;
        assert!(off.length() < 0.01 * torque.length(), "{reactions:?} for {torque}");
        assert!((reactions.area - SIDE * SIDE).abs() < 0.01 * SIDE * SIDE);
        assert!(reactions.touches(sheet) && reactions.by_cloth().len() == 1);
    }
    assert_eq!(app.world().resource::<Seen>().0, [(true, floor, sheet)]);
    app.world_mut().despawn(sheet);
    run(&mut app, 1);
    assert_eq!(app.world().resource::<Seen>().0[1..], [(false, floor, sheet)]);
    assert_eq!(of(&app), ClothReactions::default());
}

/// Height of the highest particle of a sheet, of 3 cm between particles, that falls on an upright peg of 2 cm between
/// its particles, after 0.2 s, m. The top of the peg is at the origin; without contact the sheet falls 0.2 m.
fn on_peg(features: Option<ClothFeatures>, collider_has: bool) -> f32 {
    let mut app = app();
    let height = 0.01;
    let sheet = spawn_sheet(&mut app, height);
    if let Some(features) = features {
        app.world_mut().entity_mut(sheet).insert(features);
    }
    let peg = ClothCollider { features: collider_has, ..ClothCollider::cylinder(0.3, 0.01) };
    let between = 0.5 * SIDE / 16.0;
    app.world_mut().spawn((peg, Transform::from_xyz(between, -0.3, between)));
    run(&mut app, 12);
    heights(&app, sheet, height).into_iter().fold(f32::MIN, f32::max)
}

#[test]
fn a_peg_between_particles_is_felt_where_it_is_asked_for() {
    assert!(on_peg(None, true) > -0.02);
    assert!(!ClothCollider::cylinder(0.3, 0.01).features, "only where it is asked for");
    for height in [on_peg(Some(ClothFeatures { levels: 0 }), true), on_peg(None, false)] {
        assert!(height < -0.1, "{height} m");
    }
}

/// Corners and triangles of a box, the counterclockwise side of each triangle outside.
fn box_mesh(half: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |at: u32| {
        let sign = |bit: u32| if at & bit == 0 { -half } else { half };
        Vec3::new(sign(1), sign(2), sign(4))
    };
    let faces =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    ((0..8).map(corner).collect(), triangles.collect())
}

#[test]
fn a_closed_mesh_is_solid_and_an_open_one_is_not() {
    let (corners, mut triangles) = box_mesh(0.1);
    let is_solid = |triangles: &[[u32; 3]]| {
        let collider = ClothCollider::triangles(corners.clone(), triangles.to_vec()).expect("good");
        collider.shape.contains_local_point(Vec3::new(0.01, 0.02, 0.03))
    };
    assert!(is_solid(&triangles));
    let mut turned = triangles.clone();
    turned[3].swap(0, 1);
    assert!(!is_solid(&turned));
    triangles.pop();
    assert!(!is_solid(&triangles));
}

#[test]
fn bad_meshes_are_refused() {
    let (corners, triangles) = box_mesh(0.1);
    let error = |corners: &[Vec3], triangles: &[[u32; 3]]| {
        ClothCollider::triangles(corners.to_vec(), triangles.to_vec()).err()
    };
    assert_eq!(error(&corners, &[]), Some(ColliderError::NoTriangle));
    assert_eq!(error(&corners[..7], &triangles), Some(ColliderError::Index));
    let mut infinite = corners.clone();
    infinite[2].x = f32::NAN;
    assert_eq!(error(&infinite, &triangles), Some(ColliderError::NotFinite));
    assert!(ClothCollider::convex_hull(&corners).is_some());
    assert!(ClothCollider::convex_hull(&infinite).is_none());
}

/// A sheet that falls comes to lie on the tip, edge or face of every shape that has a constructor and is felt between
/// particles. Folds over a rim may stand up to 2 cm above it.
#[test]
fn cloth_lies_on_every_shape() {
    let (corners, triangles) = box_mesh(0.1);
    let mesh = ClothCollider::triangles(corners.clone(), triangles).expect("a good mesh");
    let shapes = [
        ("cylinder", ClothCollider::cylinder(0.1, 0.1)),
        ("cone", ClothCollider::cone(0.1, 0.1)),
        ("hull", ClothCollider::convex_hull(&corners).expect("a good hull")),
        ("mesh", mesh),
    ];
    for (name, collider) in shapes {
        let mut app = app();
        let sheet = spawn_sheet(&mut app, 0.02);
        let collider = ClothCollider { features: true, ..collider };
        app.world_mut().spawn((collider, Transform::from_xyz(0.0, -0.1, 0.0)));
        run(&mut app, 30);
        let heights = heights(&app, sheet, 0.02);
        let highest = heights.iter().copied().fold(f32::MIN, f32::max);
        assert!((-0.02..0.02).contains(&highest), "{name}: {highest} m");
    }
}

/// Mean height of a strip of half a metre above the floor on which it has fallen on its edge, m: of cloth that passes
/// through itself, the thickness of its material.
fn height_of_heap(self_collision: Option<SelfCollision>) -> f32 {
    let mut app = app();
    app.world_mut().spawn(floor());
    let mesh = ClothMesh::grid(9, 17, 0.25, SIDE);
    let strip = app.world_mut().spawn((mesh, Transform::from_xyz(0.0, SIDE, 0.0))).id();
    if let Some(self_collision) = self_collision {
        app.world_mut().entity_mut(strip).insert(self_collision);
    }
    run(&mut app, 180);
    let positions = state(&app, strip).positions().to_vec();
    positions.iter().map(|at| SIDE + at.y).sum::<f32>() / positions.len() as f32
}

#[test]
fn cloth_lies_on_itself_where_it_has_the_component() {
    let apart = |thickness| Some(SelfCollision { thickness, ..Default::default() });
    let [free, unlevelled, thin, thick] =
        [None, Some(SelfCollision { levels: 0, ..Default::default() }), apart(4e-3), apart(12e-3)]
            .map(height_of_heap);
    assert_eq!(free, unlevelled);
    assert!(thin > free + 2e-3 && thick > free + 2e-3, "{free}, {thin}, {thick}");
    assert_ne!(thin, thick, "the thickness counts");
}

#[test]
fn cloth_passes_through_itself_again_without_the_component() {
    let mut app = app();
    let strip = app.world_mut().spawn((
        ClothMesh::grid(9, 17, 0.25, SIDE),
        Transform::from_xyz(0.0, SIDE, 0.0),
        SelfCollision::default(),
    ));
    let strip = strip.id();
    app.world_mut().spawn(floor());
    run(&mut app, 120);
    let height = |app: &App| {
        let positions = state(app, strip).positions().to_vec();
        positions.iter().map(|at| SIDE + at.y).sum::<f32>() / positions.len() as f32
    };
    let before = height(&app);
    app.world_mut().entity_mut(strip).remove::<SelfCollision>();
    run(&mut app, 120);
    let after = height(&app);
    assert!(after < before - 2e-3, "{before} m before, {after} m after");
}

#[test]
fn a_heap_of_cloth_falls_asleep() {
    const SECONDS: usize = 10;
    let mut app = app();
    let sheet = app.world_mut().spawn((
        ClothMesh::grid(21, 21, SIDE, SIDE),
        Transform::from_xyz(0.0, 1.05 * SIDE, 0.0),
        SelfCollision::default(),
    ));
    let sheet = sheet.id();
    app.world_mut().spawn(floor());
    let asleep = (0..64 * SECONDS).find(|_| {
        run(&mut app, 1);
        state(&app, sheet).activity() == ClothActivity::AtRest
    });
    assert!(asleep.is_some_and(|tick| tick > 64), "{asleep:?}");
    let positions = state(&app, sheet).positions();
    let highest = positions.iter().map(|at| at.y).fold(f32::NEG_INFINITY, f32::max);
    assert!(highest < -0.6 * SIDE, "{highest} m: it has fallen");
}
