//! Anchors: a band between two masts that close in hangs like a chain, and two masts that move as one are like one.

use std::f32::consts::FRAC_PI_2;
use std::time::Instant;

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::entity::Entity;
use bevy_transform::components::Transform;
use glam::{Quat, Vec3};

use crate::{
    contacts::Row,
    game,
    oracles::catenary::sag_of_chain,
    product::{DEFAULT, TICK},
};

/// A band of 1 × 0.1 m.
const COLUMNS: u32 = 33;
const ROWS: u32 = 5;
const BAND: ClothMesh = ClothMesh::grid(COLUMNS, ROWS, 1.0, 0.1);

/// Span of the masts at the end, m, and the time in which they close in, s.
const SPAN: f32 = 0.8;
const CLOSING: f32 = 4.0;

/// Greatest error of the sag at the end, of one: stretch and bending.
const SAG: f64 = 0.01;

/// Greatest error of the sag while the masts close in, m: the band swings a little.
const SAG_WHILE: f64 = 0.005;

/// Greatest distance of a particle on two masts from the same on one, m, in as many ticks: rounding. Later the taut band
/// buckles, to either side by chance.
const APART: f64 = 1e-6;
const TICKS: usize = 5;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let [mut rows, more] = [sag(if quick { 6.0 } else { 15.0 }), vec![as_one()]];
    rows.extend(more);
    rows
}

/// A mast whose x axis is the world's, with the band's width along z.
fn mast(app: &mut App, x: f32) -> Entity {
    app.world_mut().spawn(pose(Vec3::X * x)).id()
}

fn pose(at: Vec3) -> Transform {
    Transform::from_translation(at).with_rotation(Quat::from_rotation_x(-FRAC_PI_2))
}

/// A band held by its left edge at the origin of a mast, and by its right edge at that of another.
fn band(app: &mut App, [left, right]: [Entity; 2]) -> Entity {
    let held =
        Anchor::new(right, ClothEdge::Right).with_offset(Transform::from_xyz(-1.0, 0.0, 0.0));
    let attachment = Attachment::new(left, ClothEdge::Left).with_anchor(held);
    app.world_mut().spawn((BAND, attachment)).id()
}

fn positions(app: &App, cloth: Entity) -> &[Vec3] {
    app.world().get::<ClothState>(cloth).map_or(&[], ClothState::positions)
}

/// Sag of a chain of equal links, with half of the mass of a link at both of its ends, m.
fn expected(span: f32) -> f64 {
    sag_of_chain(&vec![1.0; COLUMNS as usize - 2], f64::from(span), 1.0)
}

/// Rows of the sag of a band whose masts close in: until they stand, and some seconds later.
fn sag(seconds: f32) -> Vec<Row> {
    let mut app = game::app_in_still_air([DEFAULT]);
    let masts = [0.0, 1.0].map(|x| mast(&mut app, x));
    let band = band(&mut app, masts);
    let start = Instant::now();
    let mut ticks = 0;
    let mut sag_at = |time: f32| {
        let span = 1.0 - (1.0 - SPAN) * (time / CLOSING).min(1.0);
        *app.world_mut().get_mut::<Transform>(masts[1]).expect("a mast") = pose(Vec3::X * span);
        app.update();
        ticks += 1;
        // The band's frame lies on its side: its z is up.
        let lowest = positions(&app, band).iter().map(|at| at.z).fold(0.0, f32::min);
        f64::from(-lowest) - expected(span)
    };
    let mut time = 0.0;
    let mut advance_to = |end: f32, from: f32| {
        let mut worst = (0.0_f64, 0.0_f64);
        while time < end {
            time += TICK;
            let error = sag_at(time).abs();
            worst = (if time > from { worst.0.max(error) } else { worst.0 }, error);
        }
        worst
    };
    let (while_closing, _) = advance_to(CLOSING, 0.5 * CLOSING);
    let (_, at_rest) = advance_to(CLOSING + seconds, CLOSING);
    let us = 1e6 * start.elapsed().as_secs_f64() / f64::from(ticks);
    let name = "anchors, band between masts";
    vec![
        Row::new(
            format!("{name} that close in"),
            "error of the sag, m",
            while_closing,
            SAG_WHILE,
            us,
        ),
        Row::new(
            format!("{name} at rest"),
            "error of the sag, of one",
            at_rest / expected(SPAN),
            SAG,
            us,
        ),
    ]
}

/// Row of the distance of a band on two masts that move as one from a band that both edges hold on one of them.
fn as_one() -> Row {
    let mut app = game::app_in_still_air([DEFAULT]);
    let masts = [0.0, 1.0].map(|x| mast(&mut app, x));
    let on_two = band(&mut app, masts);
    let ends = (0..ROWS).flat_map(|row| [row * COLUMNS, row * COLUMNS + COLUMNS - 1]).collect();
    let on_one = Attachment::new(masts[0], AttachedVertices::List(ends));
    let on_one = app.world_mut().spawn((BAND, on_one)).id();
    let start = Instant::now();
    let mut worst = 0.0_f32;
    for tick in 0..TICKS {
        let time = tick as f32 * TICK;
        let way = Vec3::new(0.3 * libm::sinf(4.0 * time), 0.2 * libm::sinf(3.0 * time), 0.0);
        for (mast, x) in masts.into_iter().zip([0.0, 1.0]) {
            *app.world_mut().get_mut::<Transform>(mast).expect("a mast") = pose(Vec3::X * x + way);
        }
        app.update();
        let pairs = positions(&app, on_one).iter().zip(positions(&app, on_two));
        worst = pairs.map(|(one, two)| one.distance(*two)).fold(worst, f32::max);
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / TICKS as f64;
    Row::new("anchors, two masts that move as one", "m from one mast", f64::from(worst), APART, us)
}
