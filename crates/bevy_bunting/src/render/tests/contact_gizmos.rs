//! Tests of the gizmos of contacts.

use std::f32::consts::FRAC_PI_2;

use bevy_color::Srgba;
use bevy_color::palettes::css::{AQUA, ORANGE, YELLOW};
use bevy_math::Quat;

use super::*;
use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::render::contact_lines::contact_lines;

/// Height of the floor, m.
const FLOOR: f32 = -0.3;

/// A sheet that lies level at a height, m.
fn spawn_sheet(app: &mut App, height: f32, more: impl Bundle) -> Entity {
    let at =
        Transform::from_xyz(-0.25, height, -0.25).with_rotation(Quat::from_rotation_x(-FRAC_PI_2));
    let sheet = (ClothMesh::grid(9, 9, 0.5, 0.5), at, ClothSubdivision::NONE, more);
    app.world_mut().spawn(sheet).id()
}

/// An app without wind, above a floor.
fn app_on_floor() -> App {
    let mut app = app(TICK);
    let mut winds = app.world_mut().query_filtered::<Entity, With<WindField>>();
    let winds: Vec<Entity> = winds.iter(app.world()).collect();
    winds.into_iter().for_each(|wind| {
        app.world_mut().despawn(wind);
    });
    app.world_mut().spawn((ClothCollider::ground(), Transform::from_xyz(0.0, FLOOR, 0.0)));
    app
}

/// The lines of a cloth's contacts.
fn lines(app: &App, cloth: Entity) -> Vec<(Vec3, Vec3, Srgba)> {
    let lane = app.world().get::<ClothInstance>(cloth).and_then(ClothInstance::lane);
    let frame = app.world().get::<GlobalTransform>(cloth).expect("a place");
    lane.map_or_else(Vec::new, |lane| {
        contact_lines(app.world().resource::<ClothBatches>(), lane, frame)
    })
}

#[test]
fn a_sheet_on_a_floor_has_a_line_on_each_particle() {
    let mut app = app_on_floor();
    let sheet = spawn_sheet(&mut app, FLOOR + 0.05, ());
    run(&mut app, 2);
    assert!(lines(&app, sheet).is_empty());
    run(&mut app, 30);
    let lines = lines(&app, sheet);
    assert!(lines.len() > 60, "{} lines of 81 particles", lines.len());
    for (from, to, colour) in lines {
        assert_eq!(colour, AQUA);
        assert!((from.y - FLOOR).abs() < 0.02, "{from}");
        assert!((to - from - 0.02 * Vec3::Y).length() < 1e-3, "{from} to {to}");
    }
}

#[test]
fn sheets_that_lie_on_one_another_have_lines_away_from_each_other() {
    let mut app = app_on_floor();
    let collides = ClothCollision::default();
    let [lower, upper] = [0.03, 0.06].map(|height| spawn_sheet(&mut app, FLOOR + height, collides));
    run(&mut app, 30);
    let between = |cloth: Entity| {
        let lines = lines(&app, cloth).into_iter();
        lines.filter(|line| line.2 == ORANGE).map(|(from, to, _)| to - from).collect::<Vec<_>>()
    };
    let [of_lower, of_upper] = [lower, upper].map(between);
    assert!(!of_lower.is_empty() && of_lower.len() == of_upper.len());
    // Edges may meet beside the sheets.
    let down = of_lower.iter().filter(|line| line.y < -0.01).count();
    let up = of_upper.iter().filter(|line| line.y > 0.01).count();
    assert!(2 * down > of_lower.len() && 2 * up > of_upper.len(), "{down} down, {up} up");
}

#[test]
fn a_sheet_that_falls_on_itself_has_lines_of_its_own() {
    let mut app = app_on_floor();
    // It falls on its edge.
    let at = Transform::from_xyz(0.0, FLOOR + 0.52, 0.0).with_rotation(Quat::from_rotation_x(0.1));
    let sheet = (ClothMesh::grid(17, 17, 0.5, 0.5), at, ClothSubdivision::NONE);
    let sheet = app.world_mut().spawn((sheet, SelfCollision::default())).id();
    let mut found = false;
    for _ in 0..90 {
        run(&mut app, 1);
        found |= lines(&app, sheet).iter().any(|line| line.2 == YELLOW);
    }
    assert!(found);
}
