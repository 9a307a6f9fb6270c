//! What is seen beside the cloth: rail, posts, rings and table; and what the cloth is coloured with.

use bevy::prelude::*;
use bunting_examples::{print, stage};
use bunting_scenes::Design;

use crate::curtain::{self, Curtain};
use crate::table::{self, Sheet};

/// Radius of the rail, m.
const RAIL: f32 = 0.014;

/// Radius of a ring, m: it goes round the rail, and the cloth hangs at its lowest point.
const RING: f32 = 0.032;

/// Radius of the wire of a ring, m.
const WIRE: f32 = 0.004;

/// Half the length of the rail, m.
const HALF_RAIL: f32 = 0.98;

/// Builds furniture and colours cloth.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, (put_up_rail, put_up_table, colour_cloth));
}

fn put_up_rail(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let brass = materials.add(StandardMaterial {
        base_color: Color::srgb(0.62, 0.50, 0.30),
        metallic: 0.3,
        perceptual_roughness: 0.4,
        ..default()
    });
    let places: Vec<Vec3> = curtain::ring_places().map(|place| curtain::TOP + place).collect();
    let rail = Vec3 { y: curtain::TOP.y + RING, ..places[0] };
    let middle = Vec3 { x: curtain::TOP.x, ..rail };
    let lying = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let mut spawn = |mesh: Mesh, place: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(brass.clone()), place));
    };
    spawn(
        Cylinder::new(RAIL, 2.0 * HALF_RAIL).into(),
        Transform::from_translation(middle).with_rotation(lying),
    );
    for side in [-HALF_RAIL, HALF_RAIL] {
        let post = Vec3::new(middle.x + side, 0.5 * rail.y, rail.z);
        spawn(Cylinder::new(RAIL, rail.y).into(), Transform::from_translation(post));
        spawn(Sphere::new(2.0 * RAIL).into(), Transform::from_translation(middle + side * Vec3::X));
    }
    for place in places {
        let ring = Torus { minor_radius: WIRE, major_radius: RING - WIRE };
        let centre = Vec3 { y: rail.y, ..place };
        spawn(ring.into(), Transform::from_translation(centre).with_rotation(lying));
    }
}

fn put_up_table(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let wood = materials.add(StandardMaterial {
        base_color: Color::srgb(0.45, 0.30, 0.18),
        perceptual_roughness: 0.6,
        ..default()
    });
    // The edges of the box that is drawn are not round: it is within the one that the sheet feels.
    let top = (table::TOP - 0.5 * table::ROUNDING, table::PLACE);
    for (half, place) in core::iter::once(top).chain(table::legs()) {
        commands.spawn((
            Mesh3d(meshes.add(Cuboid::from_size(2.0 * half))),
            MeshMaterial3d(wood.clone()),
            Transform::from_translation(place),
        ));
    }
}

fn colour_cloth(
    mut commands: Commands,
    curtain: Single<Entity, With<Curtain>>,
    sheet: Single<Entity, With<Sheet>>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let linen = StandardMaterial { base_color: Color::srgb(0.36, 0.49, 0.55), ..stage::cloth() };
    let chequers = Design::Chequers { colours: [[236, 232, 222], [186, 58, 52]], rows: 16 };
    let picture = images.add(print::picture(&chequers, Vec2::new(1.7, 1.45)));
    let gingham = StandardMaterial { base_color_texture: Some(picture), ..stage::cloth() };
    commands.entity(*curtain).insert(MeshMaterial3d(materials.add(linen)));
    commands.entity(*sheet).insert(MeshMaterial3d(materials.add(gingham)));
}
