//! Item 13: the drawn surface keeps out of shapes, as its particles do.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{app, bits, run, state};

/// Half extents of the box, m.
const BOX: Vec3 = Vec3::new(0.3, 0.2, 0.25);

const MARGIN: f32 = 0.008;

/// Number of points along each side of a triangle at which the surface is tested.
const PROBES: u32 = 12;

/// A displayed sheet of 33 × 33 particles, 3 cm apart, above a sharp axis-aligned box at the origin.
fn draped(app: &mut App, turn: f32) -> Entity {
    let sheet = undisplayed(app, turn);
    app.world_mut().entity_mut(sheet).insert(ClothSurface::default());
    sheet
}

/// The sheet without a displayed surface, which would be lifted.
fn undisplayed(app: &mut App, turn: f32) -> Entity {
    let flat = Quat::from_rotation_y(turn) * Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    let middle = flat * Vec3::new(0.5, -0.5, 0.0);
    let place = Transform::from_translation(Vec3::Y * 0.25 - middle).with_rotation(flat);
    let sheet = (ClothMesh::grid(33, 33, 1.0, 1.0), place);
    // Only particles touch, so that triangles cut the box and are lifted.
    let collider = ClothCollider { margin: MARGIN, ..ClothCollider::cuboid(BOX) };
    app.world_mut().spawn((collider, Transform::default()));
    app.world_mut().spawn(sheet).id()
}

/// Depth by which a surface with the given positions cuts into the box, m; negative if it stays clear.
fn depth(app: &App, sheet: Entity, positions: &[Vec3]) -> f32 {
    let placed = *app.world().get::<GlobalTransform>(sheet).expect("placed");
    let fabric = state(app, sheet).fabric().expect("a fabric");
    let mut deepest = f32::MIN;
    for triangle in fabric.triangles() {
        let [a, b, c] = triangle.map(|at| placed.transform_point(positions[at as usize]));
        for i in 0..=PROBES {
            for j in 0..=PROBES - i {
                let (u, v) = (i as f32 / PROBES as f32, j as f32 / PROBES as f32);
                let at = a + (b - a) * u + (c - a) * v;
                deepest = deepest.max((BOX - at.abs()).min_element());
            }
        }
    }
    deepest
}

#[test]
fn a_sharp_box_does_not_show_through() {
    for turn in [0.0, 0.4, 0.8] {
        let mut app = app();
        let sheet = draped(&mut app, turn);
        run(&mut app, 20);
        let mut cut = f32::MIN;
        for tick in 0..180 {
            app.update();
            cut = cut.max(depth(&app, sheet, state(&app, sheet).positions()));
            let shown = &app.world().get::<ClothSurface>(sheet).expect("a surface").positions;
            let shown = depth(&app, sheet, shown);
            assert!(shown < 0.0, "the box shows by {shown} m in tick {tick}, turned by {turn}");
        }
        assert!(cut > 1e-3, "triangles between particles cut into the box by {cut} m only");
    }
}

#[test]
fn the_lift_changes_no_particle() {
    let mut app = app();
    let sheet = draped(&mut app, 0.4);
    let mut other = self::app();
    let same = undisplayed(&mut other, 0.4);
    run(&mut app, 60);
    run(&mut other, 60);
    assert_eq!(bits(&app, sheet), bits(&other, same));
}
