//! A cape that begins, or is reset, where a leg in mid-stride pierces its shape at rest: it must get free of the leg, and must
//! not be drawn out for ever.

use bevy_bunting::{
    Attachment, ClothCollider, ClothEdge, ClothMaterial, ClothMesh, TeleportCloth, TeleportMode,
};
use bevy_ecs::{entity::Entity, hierarchy::ChildOf};
use bevy_transform::components::Transform;
use glam::{Quat, Vec3};

use super::{in_app::InApp, row::Row};
use crate::{scenes::ticks, stats::worse};

/// Vertices across and down, and size, m.
const VERTICES: [u32; 2] = [17, 25];
const SIZE: [f32; 2] = [0.5, 1.1];
/// Half the length of a leg's axis and its radius, m.
const LEG: [f32; 2] = [0.35, 0.09];
/// Distance that the cape keeps from the leg, m.
const MARGIN: f32 = 0.01;
/// Places of hip and chest, m, and of the cape's left upper corner beside the chest.
const HIP: Vec3 = Vec3::new(0.1, 0.9, 0.0);
const CHEST: Vec3 = Vec3::new(0.0, 1.25, 0.0);
const COLLAR: Vec3 = Vec3::new(-0.25, 0.22, 0.2);
/// Angle by which the leg is swung back, rad: a stride.
const STRIDE: f32 = 0.5;
/// Time after which the cape must be free, and time in which its strain is measured then, s.
const FREE: f64 = 0.5;
const MEASURED: f64 = 0.5;
/// Greatest strain of 99.9 % of warp and weft then, %.
const STRAIN: f64 = 10.0;

pub(super) fn rows(_: bool) -> Vec<Row> {
    let mut rows: Vec<Row> = [false, true].map(begun).into();
    rows.push(reset());
    rows
}

/// An app with a leg, and an entity at the chest.
fn figure(features: bool) -> (InApp, [Entity; 2]) {
    let mut app = InApp::new();
    let chest = app.spawn(Transform::from_translation(CHEST));
    let hip = app.spawn(Transform::from_translation(HIP));
    let [half_length, radius] = LEG;
    let leg =
        ClothCollider { margin: MARGIN, features, ..ClothCollider::capsule(half_length, radius) };
    app.spawn((leg, Transform::from_xyz(0.0, -half_length - radius, 0.0), ChildOf(hip)));
    (app, [chest, hip])
}

fn swung_back(angle: f32) -> Transform {
    Transform::from_translation(HIP).with_rotation(Quat::from_rotation_x(-angle))
}

fn spawn_cape(app: &mut InApp, chest: Entity) -> Entity {
    let [columns, rows] = VERTICES;
    app.spawn((
        ClothMesh::grid(columns, rows, SIZE[0], SIZE[1]),
        ClothMaterial::COTTON,
        Attachment::new(chest, ClothEdge::Top).with_offset(Transform::from_translation(COLLAR)),
    ))
}

/// Greatest strain of the cape once it should be free, %.
fn strain(app: &mut InApp, cape: Entity) -> f64 {
    app.updates(ticks(FREE));
    let strains = (0..ticks(MEASURED)).map(|_| {
        app.update();
        app.strain(cape).p999 * 100.0
    });
    strains.fold(0.0, worse)
}

fn row(name: &str, strain: f64, app: &InApp) -> Row {
    Row::new(name, "99.9 % of warp and weft half a second later, %", strain, STRAIN, app.us())
}

/// Row of a cape that is spawned over a leg that stands still.
fn begun(features: bool) -> Row {
    let (mut app, [chest, hip]) = figure(features);
    app.move_to(hip, swung_back(STRIDE));
    app.updates(2);
    let cape = spawn_cape(&mut app, chest);
    let strain = strain(&mut app, cape);
    let name = match features {
        false => "cape that begins with a leg through it",
        true => "cape that begins with a leg through it, features",
    };
    row(name, strain, &app)
}

/// Row of a cape that the leg has pushed back before it is reset, as after a respawn.
fn reset() -> Row {
    let (mut app, [chest, hip]) = figure(false);
    let cape = spawn_cape(&mut app, chest);
    app.updates(2);
    for tick in 1..=ticks(0.5) {
        app.move_to(hip, swung_back(STRIDE * tick as f32 / ticks(0.5) as f32));
        app.update();
    }
    app.world().trigger(TeleportCloth { entity: cape, mode: TeleportMode::Reset });
    let strain = strain(&mut app, cape);
    row("cape that is reset with a leg through it", strain, &app)
}
