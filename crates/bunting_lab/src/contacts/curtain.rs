//! A ball that flies through a hanging curtain at the speeds of a walk, a run and a throw: the curtain need not stretch, as it
//! can give way.

use bevy_bunting::{Attachment, ClothCollider, ClothEdge, ClothMaterial, ClothMesh};
use bevy_transform::components::Transform;
use glam::Vec3;

use super::{in_app::InApp, row::Row};
use crate::{product::TICK, scenes::ticks, stats::worse};

/// Vertices along each side of the curtain.
const SIZE: u32 = 33;
/// Side of the curtain, m.
const SIDE: f32 = 2.0;
/// Radius of the ball, m.
const RADIUS: f32 = 0.11;
/// The ball's way from the curtain's left upper corner, m: it flies along z. The curtain ends before the way does.
const WAY: [Vec3; 2] = [Vec3::new(1.2, -1.2, -0.3), Vec3::new(1.2, -1.2, 2.5)];
/// Speeds, m/s.
const SPEEDS: [f32; 3] = [1.0, 3.0, 10.0];
/// Time after the ball has passed until the curtain should have recovered, s.
const AFTER: f64 = 1.0;
/// Greatest stretch of a link along warp and weft in any tick, and that after a second, %.
const STRETCH: [f64; 2] = [30.0, 2.0];

pub(super) fn rows(_: bool) -> Vec<Row> {
    SPEEDS.into_iter().flat_map(fly).collect()
}

fn fly(speed: f32) -> [Row; 2] {
    let mut app = InApp::new();
    let curtain = app.spawn((
        ClothMesh::grid(SIZE, SIZE, SIDE, SIDE),
        ClothMaterial::COTTON,
        Attachment::in_place(ClothEdge::Top),
    ));
    let [from, to] = WAY;
    let ball = ClothCollider { features: false, ..ClothCollider::ball(RADIUS) };
    let ball = app.spawn((ball, Transform::from_translation(from)));
    app.update();
    let mut greatest = 0.0;
    let flying = ((to - from).length() / (speed * TICK)).ceil();
    for tick in 1..=flying as usize {
        let at = from.lerp(to, tick as f32 / flying);
        app.move_to(ball, Transform::from_translation(at));
        app.update();
        greatest = worse(greatest, app.greatest_stretch(curtain) * 100.0);
    }
    app.updates(ticks(AFTER));
    let after = app.strain(curtain).p999 * 100.0;
    let name = format!("ball at {speed} m/s through a curtain");
    let us = app.us();
    [
        Row::new(name.clone(), "greatest stretch of a link in a tick, %", greatest, STRETCH[0], us),
        Row::new(
            format!("{name}, one second later"),
            "strain of 99.9 % of warp and weft, %",
            after,
            STRETCH[1],
            us,
        ),
    ]
}
