//! Draws rail, posts, rings and table, and prints the cloth.

use crate::render::{print, stage};
use bevy::prelude::*;

use crate::scenes::drape::{curtain, table};

/// Radius of the rail, m.
const RAIL: f32 = 0.014;

/// Radius of a ring, m. The ring lies around the rail, and the cloth hangs at its lowest point.
const RING: f32 = 0.032;

/// Radius of the wire of a ring, m.
const WIRE: f32 = 0.004;

/// Half the length of the rail, m.
const HALF_RAIL: f32 = 0.98;

/// Draws the furniture and prints the cloths.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth()))
        .add_systems(PostStartup, (draw_rail, draw_table));
}

fn draw_rail(
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
    let rings: Vec<Vec3> = curtain::ring_positions().map(|ring| curtain::TOP + ring).collect();
    let rail = Vec3 { y: curtain::TOP.y + RING, ..rings[0] };
    let middle = Vec3 { x: curtain::TOP.x, ..rail };
    let along_rail = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let mut spawn = |mesh: Mesh, pose: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(brass.clone()), pose));
    };
    spawn(
        Cylinder::new(RAIL, 2.0 * HALF_RAIL).into(),
        Transform::from_translation(middle).with_rotation(along_rail),
    );
    for side in [-HALF_RAIL, HALF_RAIL] {
        let post = Vec3::new(middle.x + side, 0.5 * rail.y, rail.z);
        spawn(Cylinder::new(RAIL, rail.y).into(), Transform::from_translation(post));
        spawn(Sphere::new(2.0 * RAIL).into(), Transform::from_translation(middle + side * Vec3::X));
    }
    for ring in rings {
        let torus = Torus { minor_radius: WIRE, major_radius: RING - WIRE };
        let centre = Vec3 { y: rail.y, ..ring };
        spawn(torus.into(), Transform::from_translation(centre).with_rotation(along_rail));
    }
}

fn draw_table(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let wood = materials.add(StandardMaterial {
        base_color: Color::srgb(0.45, 0.30, 0.18),
        perceptual_roughness: 0.6,
        ..default()
    });
    // The drawn box has sharp edges, and is smaller so that it lies within the collider's rounded box.
    let top = (table::TOP - 0.5 * table::ROUNDING, table::CENTRE);
    for (half, centre) in core::iter::once(top).chain(table::legs()) {
        commands.spawn((
            Mesh3d(meshes.add(Cuboid::from_size(2.0 * half))),
            MeshMaterial3d(wood.clone()),
            Transform::from_translation(centre),
        ));
    }
}
