//! Draws rail, rings and hand, and prints the cloth.

use std::f32::consts::FRAC_PI_2;

use crate::render::{print, stage};
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::curtain::hand::Hand;
use crate::scenes::curtain::rail::{END, RAIL, rings};

/// Radius of the rail, m.
const RADIUS: f32 = 0.012;

/// Radius of a ring, m, which hangs on the rail and carries the cloth at its lowest point.
const RING: f32 = 0.03;

/// Radius of the wire of a ring, m.
const WIRE: f32 = 0.004;

/// A drawn ring, and its vertex.
#[derive(Component)]
struct Ring(u32);

/// Draws the furniture and prints the cloth.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth()))
        .add_systems(PostStartup, draw_rail)
        .add_systems(Update, slide_rings);
}

fn draw_rail(
    mut commands: Commands,
    hands: Query<Entity, With<Hand>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let brass = materials.add(StandardMaterial {
        base_color: Color::srgb(0.62, 0.50, 0.30),
        metallic: 0.3,
        perceptual_roughness: 0.4,
        ..default()
    });
    let skin = materials.add(StandardMaterial {
        base_color: Color::srgb(0.85, 0.66, 0.54),
        perceptual_roughness: 0.7,
        ..default()
    });
    let along_rail = Quat::from_rotation_z(FRAC_PI_2);
    let left = END + RING * Vec3::Y;
    let mut spawn = |mesh: Mesh, pose: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(brass.clone()), pose)).id()
    };
    let middle = left + 0.5 * RAIL * Vec3::X;
    spawn(
        Cylinder::new(RADIUS, RAIL + 0.1).into(),
        Transform::from_translation(middle).with_rotation(along_rail),
    );
    for side in [-0.05, RAIL + 0.05] {
        let post = Vec3::new(left.x + side, 0.5 * left.y, left.z);
        spawn(Cylinder::new(RADIUS, left.y).into(), Transform::from_translation(post));
        let knob = left + side * Vec3::X;
        spawn(Sphere::new(2.0 * RADIUS).into(), Transform::from_translation(knob));
    }
    let drawn: Vec<(Entity, u32)> = rings()
        .map(|vertex| {
            let torus = Torus { minor_radius: WIRE, major_radius: RING - WIRE };
            let pose = Transform::from_translation(left).with_rotation(along_rail);
            (spawn(torus.into(), pose), vertex)
        })
        .collect();
    for (ring, vertex) in drawn {
        commands.entity(ring).insert(Ring(vertex));
    }
    for hand in &hands {
        let fist = Mesh3d(meshes.add(Sphere::new(0.05)));
        commands.entity(hand).insert((fist, MeshMaterial3d(skin.clone())));
    }
}

/// Puts the rings where the cloth hangs on them.
fn slide_rings(
    mut drawn: Query<(&Ring, &mut Transform)>,
    cloths: Query<(&ClothSurface, &GlobalTransform)>,
) {
    for (surface, frame) in &cloths {
        for (ring, mut transform) in &mut drawn {
            if let Some(&at) = surface.positions.get(ring.0 as usize) {
                transform.translation = frame.transform_point(at) + RING * Vec3::Y;
            }
        }
    }
}
