//! Springs and rails: a static stretch, and sheets that slide down inclined rails.

use std::time::Instant;

use bevy_bunting::WakeCloth;
use bevy_bunting::prelude::*;
use bevy_transform::components::Transform;
use glam::Vec3;

use crate::{
    contacts::Row,
    game,
    product::{DEFAULT, TICK},
};

/// Material that comes to rest, and one without damping.
const DAMPED: FabricMaterial = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };
const UNDAMPED: FabricMaterial = FabricMaterial { damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };

/// Standard gravity, m/s².
const GRAVITY: f32 = 9.81;

/// Greatest errors, of one.
const STRETCH: f64 = 0.01;
const SLIDE: f64 = 0.01;

/// Inclination of the rails, rad.
const ANGLE: f32 = 0.4;

const COLUMNS: usize = 17;

/// Mean position of the upper edge of a sheet in the world after some seconds, m, and the time of a tick, µs.
fn edge_after(
    seconds: f32,
    material: FabricMaterial,
    hold: AnchorHold,
    turn: f32,
) -> (Vec3, Vec3, f64) {
    let mut app = game::app_in_still_air([DEFAULT]);
    app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    let pose = Transform::from_rotation(glam::Quat::from_rotation_z(turn));
    let post = app.world_mut().spawn(pose).id();
    let anchor = Anchor::new(post, ClothEdge::Top).with_hold(hold);
    let attachment = Attachment::new(post, AttachedVertices::List(Vec::new())).with_anchor(anchor);
    let n = COLUMNS as u32;
    let sheet = (ClothMesh::grid(n, n, 1.0, 1.0), ClothMaterial(material), attachment);
    let sheet = app.world_mut().spawn(sheet).id();
    let edge = |app: &bevy_app::App| {
        let positions = app.world().get::<ClothState>(sheet).map_or(&[][..], |it| it.positions());
        let sum: Vec3 = positions.iter().take(COLUMNS).sum();
        pose.rotation * (sum / COLUMNS as f32)
    };
    // The first update has no tick.
    app.update();
    let ticks = libm::roundf(seconds / TICK) as usize;
    let start = Instant::now();
    for _ in 0..ticks {
        // What is left of the motion when cloth falls asleep is more than what is measured here.
        app.world_mut().trigger(WakeCloth { entity: sheet });
        app.update();
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    (edge(&app), pose.rotation * Vec3::new(0.5, 0.0, 0.0), us)
}

fn stretch(stiffness: f32, seconds: f32) -> Row {
    let hold = AnchorHold::Spring { stiffness, max_force: f32::INFINITY };
    let (edge, rest, us) = edge_after(seconds, DAMPED, hold, 0.0);
    let expected = f64::from(DAMPED.area_density * GRAVITY / stiffness);
    let error = f64::from(rest.y - edge.y) / expected - 1.0;
    let name = format!("holds, springs of {stiffness} N/m");
    Row::new(name, "error of the stretch, of one", error.abs(), STRETCH, us)
}

fn slide(friction: f32) -> Row {
    const SECONDS: f32 = 2.0;
    let points = vec![-Vec3::X, 100.0 * Vec3::X];
    let hold = AnchorHold::Rail { points, ring_mass: 0.005, friction };
    let (edge, rest, us) = edge_after(SECONDS, UNDAMPED, hold, -ANGLE);
    let along = Vec3::new(libm::cosf(ANGLE), -libm::sinf(ANGLE), 0.0);
    let rate = GRAVITY * (libm::sinf(ANGLE) - friction * libm::cosf(ANGLE));
    let expected = f64::from(0.5 * rate * SECONDS * SECONDS);
    let error = f64::from((edge - rest).dot(along)) / expected - 1.0;
    let name = format!("holds, rings with a friction of {friction} on a rail");
    Row::new(name, "error of the way, of one", error.abs(), SLIDE, us)
}

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let seconds = if quick { 15.0 } else { 30.0 };
    let mut rows: Vec<Row> = [10.0, 100.0, 1000.0].map(|it| stretch(it, seconds)).into();
    rows.extend([0.0, 0.2].map(slide));
    rows
}
