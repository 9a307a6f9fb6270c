//! A tablecloth that hangs over the edges of a table and is pulled off: it must come off, and need not stretch.

use bevy_bunting::{ClothCollider, ClothGrab, ClothMaterial, ClothMesh, GrabbedVertices};
use bevy_transform::components::{GlobalTransform, Transform};
use glam::{Quat, Vec3};

use super::{in_app::InApp, row::Row};
use crate::{product::TICK, scenes::ticks, stats::worse};

/// Vertices along each side of the cloth.
const SIZE: u32 = 25;
/// Side of the cloth, m.
const SIDE: f32 = 1.4;
/// Half extents of the table, which stands on the floor, m.
const TABLE: Vec3 = Vec3::new(0.6, 0.375, 0.6);
/// Friction of the table.
const FRICTION: f32 = 0.3;
/// Speed of the hand that pulls, m/s, and how far it goes and rises, m.
const SPEED: f32 = 1.0;
const PULL: f32 = 2.0;
const RISE: f32 = 0.3;
/// Stiffness of the hand's grip, N/m.
const GRIP: f32 = 3000.0;
/// Time until the cloth has come to rest, and time after the pull, s.
const SETTLING: f64 = 1.5;
const AFTER: f64 = 0.5;
/// Greatest strain of 99.9 % of warp and weft in any tick, %.
const STRAIN: f64 = 10.0;

/// Rows of the strain, and of how much of the cloth is left on the table.
pub(super) fn rows(_: bool) -> Vec<Row> {
    let mut app = InApp::new();
    app.spawn(ClothCollider { features: false, ..ClothCollider::ground() });
    app.spawn((
        ClothCollider { friction: FRICTION, features: false, ..ClothCollider::cuboid(TABLE) },
        Transform::from_xyz(0.0, TABLE.y, 0.0),
    ));
    let top = 2.0 * TABLE.y + 0.01;
    let level = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let cloth = app.spawn((
        ClothMesh::grid(SIZE, SIZE, SIDE, SIDE),
        ClothMaterial::COTTON,
        Transform::from_xyz(-0.5 * SIDE, top, -0.5 * SIDE).with_rotation(level),
    ));
    app.updates(ticks(SETTLING));
    let edge = (0..SIZE).map(|row| row * SIZE + SIZE - 1).collect();
    let start = Vec3::new(0.5 * SIDE, top, 0.0);
    let hand = app.spawn((
        Transform::from_translation(start),
        ClothGrab::new(cloth, GrabbedVertices::List(edge)).with_strength(GRIP, f32::INFINITY),
    ));
    let (pulling, mut strain) = (ticks((PULL / SPEED).into()), 0.0);
    for tick in 1..=pulling + ticks(AFTER) {
        let pulled = (SPEED * TICK * tick as f32).min(PULL);
        let moved = Vec3::new(pulled, pulled.min(RISE), 0.0);
        app.move_to(hand, Transform::from_translation(start + moved));
        app.update();
        strain = worse(strain, app.strain(cloth).p999 * 100.0);
    }
    let to_world = *app.world().get::<GlobalTransform>(cloth).expect("a cloth has a place");
    let places = app.positions(cloth).iter().map(|at| to_world.transform_point(*at));
    // Stretched cloth reaches from the hand back to the table.
    let left = places.map(|at| f64::from(TABLE.x - at.x)).fold(0.0, worse);
    let us = app.us();
    let name = "tablecloth that is pulled off";
    vec![
        Row::new(format!("{name}: strain"), "99.9 % of warp and weft, %", strain, STRAIN, us),
        Row::new(format!("{name}: left behind"), "part over the table, m", left, 0.0, us),
    ]
}
