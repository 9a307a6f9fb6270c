//! Tests of air inside cloths.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, bits, greatest_speed, run, spawn_flag, state};

/// Radius of the balls, m.
const RADIUS: f32 = 0.2;

/// The mesh of a ball, or of its upper half, of rings of triangles; both are wound outwards.
fn shell(is_whole: bool) -> ClothMesh {
    const AROUND: u32 = 16;
    let rings = if is_whole { 8 } else { 4 };
    let at = |ring: u32, index: u32| {
        let (out, up) = (ring as f32 * core::f32::consts::PI / 8.0).sin_cos();
        let (sin, cos) = (index as f32 / AROUND as f32 * core::f32::consts::TAU).sin_cos();
        RADIUS * Vec3::new(out * cos, up, out * sin)
    };
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for ring in 0..rings {
        for index in 0..AROUND {
            let [a, b] = [index, index + 1].map(|index| at(ring, index));
            let [c, d] = [index + 1, index].map(|index| at(ring + 1, index));
            for corners in [[a, b, c], [a, c, d]] {
                if corners[0].distance(corners[1]).min(corners[1].distance(corners[2])) > 1e-4 {
                    let first = positions.len() as u32;
                    positions.extend(corners);
                    indices.extend([first, first + 1, first + 2]);
                }
            }
        }
    }
    let mesh = ClothMesh::triangles(positions, indices, Vec::new());
    mesh.repaired().expect("a good mesh").0
}

fn ball() -> impl Bundle {
    let cover = FabricMaterial { area_density: 0.2, ..FabricMaterial::NYLON };
    (shell(true), ClothMaterial(cover), ClothResolution::CellSize(0.04))
}

/// Height of the highest particle over the lowest, m.
fn height(app: &App, cloth: Entity) -> f32 {
    let heights = state(app, cloth).positions().iter().map(|at| at.y);
    let [low, high] = [heights.clone().fold(f32::MAX, f32::min), heights.fold(f32::MIN, f32::max)];
    high - low
}

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

fn ground(app: &mut App) {
    let ground = ClothCollider::ground();
    app.world_mut().spawn((ground, Transform::from_xyz(0.0, -RADIUS, 0.0)));
}

#[test]
fn a_ball_on_the_ground_stays_round_while_it_has_air() {
    let mut app = app();
    ground(&mut app);
    let flat = app.world_mut().spawn(ball()).id();
    let apart = Transform::from_xyz(3.0, 0.0, 0.0);
    let full = app.world_mut().spawn((ball(), apart, ClothPressure::sealed(15.0))).id();
    let apart = Transform::from_xyz(6.0, 0.0, 0.0);
    let pumped = (ball(), apart, ClothPressure::Constant { pressure: 30.0 });
    let pumped = app.world_mut().spawn(pumped).id();
    run(&mut app, 640);
    assert_eq!(errors(&app), []);
    assert!(height(&app, flat) < 1.5 * RADIUS, "{} m", height(&app, flat));
    for full in [full, pumped] {
        assert_finite(&app, full);
        assert!(height(&app, full) > 1.65 * RADIUS, "{} m", height(&app, full));
        assert!(greatest_speed(&app, full) < 0.2, "{} m/s", greatest_speed(&app, full));
    }
    // Let out, even while it sleeps.
    let before = height(&app, pumped);
    app.world_mut().entity_mut(pumped).remove::<ClothPressure>();
    run(&mut app, 320);
    let after = height(&app, pumped);
    assert!(after < 0.9 * before, "{after} of {before} m");
}

#[test]
fn hard_pressure_takes_more_substeps() {
    let mut app = app();
    let with = |app: &mut App, pressure: f32| {
        let air = ClothPressure::Constant { pressure };
        let cloth = app.world_mut().spawn((ball(), air)).id();
        run(app, 64);
        assert_finite(app, cloth);
        let effort = app.world().get::<bevy_bunting::ClothEffort>(cloth).expect("an effort");
        let needed = effort.needed().substeps;
        app.world_mut().despawn(cloth);
        needed
    };
    let [soft, hard] = [5.0, 500.0].map(|pressure| with(&mut app, pressure));
    assert!(hard > 2 * soft, "{soft} and {hard} substeps");
}

#[test]
fn air_in_an_open_mesh_and_numbers_that_cannot_be_are_reported_once() {
    let mut app = app();
    let open = app.world_mut().spawn((shell(false), ClothPressure::sealed(10.0))).id();
    run(&mut app, 10);
    let [ClothError::OpenPressure { entity, area }] = errors(&app)[..] else {
        panic!("{:?}", errors(&app));
    };
    let mouth = core::f32::consts::PI * RADIUS * RADIUS;
    assert!(entity == open && (area / mouth - 1.0).abs() < 0.2, "{area} m²");
    let text = errors(&app)[0].to_string();
    assert!(text.contains(&open.to_string()) && text.contains("ClothPressure::CANOPY"), "{text}");
    app.world_mut().entity_mut(open).insert(ClothPressure::CANOPY);
    run(&mut app, 10);
    assert_eq!(errors(&app).len(), 1);
    app.world_mut().entity_mut(open).insert(ClothPressure::sealed(10.0));
    run(&mut app, 10);
    app.world_mut().entity_mut(open).insert(ClothPressure::Constant { pressure: f32::NAN });
    run(&mut app, 10);
    assert!(
        matches!(
            errors(&app)[1..],
            [ClothError::OpenPressure { .. }, ClothError::Pressure { entity, name: "pressure", .. }] if entity == open
        ),
        "{:?}",
        errors(&app)
    );
    assert_finite(&app, open);
}

#[test]
fn cloth_beside_cloth_with_air_keeps_its_bits() {
    let flag_with = |air: Option<ClothPressure>| {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        let other = spawn_flag(&mut app, Vec3::X * 3.0);
        if let Some(air) = air {
            app.world_mut().entity_mut(other).insert(air);
        }
        run(&mut app, 60);
        [bits(&app, flag), bits(&app, other)]
    };
    let [flag, other] = flag_with(None);
    let [beside, pushed] = flag_with(Some(ClothPressure::Constant { pressure: 2.0 }));
    assert_eq!(flag, beside);
    assert_ne!(other, pushed);
}

/// Vertical speed of a canopy of cloth without load after some seconds, m/s.
fn falls(air: Option<ClothPressure>) -> f32 {
    let mut app = app();
    let light = FabricMaterial { friction_coefficient: 0.0, ..FabricMaterial::NYLON };
    let canopy = (shell(false), ClothMaterial(light), ClothResolution::CellSize(0.05));
    let canopy = app.world_mut().spawn(canopy).id();
    if let Some(air) = air {
        app.world_mut().entity_mut(canopy).insert(air);
    }
    let height = |app: &App| {
        let positions = state(app, canopy).positions();
        positions.iter().map(|at| at.y).sum::<f32>() / positions.len() as f32
    };
    run(&mut app, 32);
    let before = height(&app);
    run(&mut app, 16);
    assert_finite(&app, canopy);
    4.0 * (before - height(&app))
}

#[test]
fn a_canopy_falls_slower_than_cloth_that_the_stream_passes() {
    let [stream, trapped] = [None, Some(ClothPressure::CANOPY)].map(falls);
    assert!(trapped < 0.9 * stream && trapped > 0.3 * stream, "{trapped} and {stream} m/s");
}
