//! Sheets that lie on shapes in an app: how far they are strained, whether they fall asleep, and whether they tremble before.

use bevy_bunting::{ClothCollider, ClothMaterial, ClothMesh};
use bevy_transform::components::Transform;
use glam::{Quat, Vec3};

use super::{in_app::InApp, row::Row, shapes::blob};
use crate::{scenes::ticks, stats::worse};

/// Vertices along each side of a sheet of a metre.
const SIZE: u32 = 33;
/// Distance of the sheet above the shape at the start, m.
const GAP: f32 = 0.02;
/// Time within which a sheet should fall asleep, s.
const SLEEPY: f64 = 10.0;
/// Time in which it falls on the shape, s: its strain is measured from then on.
const FALLING: f64 = 1.0;
/// Time before it falls asleep in which it should not tremble, s.
const CALM: f64 = 1.0;
/// Greatest turn of a normal in a tick in that time, °. Larger: shading flickers.
const TURN: f64 = 0.2;
/// Half the side of the box, and radius of the ball, m.
const HALF: f32 = 0.25;
const RADIUS: f32 = 0.3;

/// A shape under the middle of a sheet.
struct Shape {
    name: &'static str,
    collider: ClothCollider,
    turn: Quat,
    /// Height of its highest point above its middle, m.
    top: f32,
    /// Greatest strain of 99.9 % of the sheet's links along warp and weft that passes, %.
    strain: f64,
}

/// Rows of each shape whose edges are not felt between particles, as by default, and of one whose edges are.
pub(super) fn rows(_: bool) -> Vec<Row> {
    let [ball, cuboid, corner, mesh] = shapes();
    let without = [&ball, &cuboid, &corner, &mesh].map(|shape| (shape, false));
    let cases = without.into_iter().chain([(&ball, true), (&cuboid, true)]);
    cases.flat_map(|(shape, features)| lying(shape, features)).collect()
}

fn shapes() -> [Shape; 4] {
    let shape =
        |name, collider, top, strain| Shape { name, collider, turn: Quat::IDENTITY, top, strain };
    let cuboid = || ClothCollider::cuboid(Vec3::splat(HALF));
    let (corners, triangles) = blob();
    let highest = corners.iter().map(|at| at.y).fold(f32::MIN, f32::max);
    let blob = ClothCollider::triangles(corners, triangles).expect("a good mesh");
    [
        shape("ball", ClothCollider::ball(RADIUS), RADIUS, 3.0),
        shape("box", cuboid(), HALF, 4.0),
        Shape {
            turn: Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Y),
            ..shape("corner of a box", cuboid(), HALF * 3_f32.sqrt(), 5.0)
        },
        shape("mesh of 224 triangles", blob, highest, 4.0),
    ]
}

fn lying(shape: &Shape, features: bool) -> [Row; 3] {
    let mut app = InApp::new();
    app.spawn((
        ClothCollider { features, ..shape.collider.clone() },
        Transform::from_translation(-(shape.top + GAP) * Vec3::Y).with_rotation(shape.turn),
    ));
    let level = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let sheet = app.spawn((
        ClothMesh::grid(SIZE, SIZE, 1.0, 1.0),
        ClothMaterial::COTTON,
        Transform::from_xyz(-0.5, 0.0, -0.5).with_rotation(level),
    ));
    app.updates(ticks(FALLING));
    let (mut strain, mut asleep, mut turns) = (0.0, f64::INFINITY, Vec::new());
    for tick in ticks(FALLING)..ticks(SLEEPY) {
        app.update();
        if app.is_asleep(sheet) {
            asleep = tick as f64 / ticks(1.0) as f64;
            break;
        }
        strain = worse(strain, app.strain(sheet).p999 * 100.0);
        turns.push(app.greatest_turn(sheet));
    }
    let calm = &turns[turns.len() - ticks(CALM).min(turns.len())..];
    let turn = calm.iter().copied().fold(0.0, worse);
    let name = match features {
        false => format!("sheet on a {}", shape.name),
        true => format!("sheet on a {}, features", shape.name),
    };
    let us = app.us();
    [
        Row::new(format!("{name}: strain"), "99.9 % of warp and weft, %", strain, shape.strain, us),
        Row::new(format!("{name}: sleeps"), "s until asleep", asleep, SLEEPY, us),
        Row::new(
            format!("{name}: trembles"),
            "turn of a normal in a tick at rest, °",
            turn,
            TURN,
            us,
        ),
    ]
}
