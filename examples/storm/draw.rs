//! Draws masts, the road and the truck, and prints the flags.

use bevy::prelude::*;
use bunting_examples::render::stage::Stage;
use bunting_examples::render::{print, stage};

use crate::field::Mast;
use crate::weather::Truck;

/// Sky, ground and light of a wide field.
pub const STAGE: Stage = Stage::SMALL;

/// Half of the truck's edges, m.
const TRUCK: Vec3 = Vec3::new(4.0, 1.4, 1.1);

/// Draws the scene.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::flag_cloth()))
        .add_systems(PostStartup, (draw_masts, draw_truck));
}

fn draw_masts(
    mut commands: Commands,
    masts: Query<Entity, With<Mast>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let shaft = meshes.add(Cylinder::new(Mast::RADIUS, Mast::HEIGHT).mesh().resolution(8));
    let paint = materials.add(stage::paint());
    for mast in &masts {
        let middle = Transform::from_xyz(0.0, 0.5 * Mast::HEIGHT, 0.0);
        commands.entity(mast).insert(Visibility::default()).with_children(|parts| {
            parts.spawn((Mesh3d(shaft.clone()), MeshMaterial3d(paint.clone()), middle));
        });
    }
}

fn draw_truck(
    mut commands: Commands,
    trucks: Query<Entity, With<Truck>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let grey = StandardMaterial {
        base_color: Color::srgb(0.22, 0.22, 0.23),
        perceptual_roughness: 0.95,
        ..default()
    };
    let grey = materials.add(grey);
    let road = meshes.add(Cuboid::new(200.0, 0.06, 4.0));
    commands.spawn((Mesh3d(road), MeshMaterial3d(grey)));
    let paint = materials.add(Color::srgb(0.15, 0.35, 0.6));
    let body = meshes.add(Cuboid::from_size(2.0 * TRUCK));
    for truck in &trucks {
        commands.entity(truck).insert((Mesh3d(body.clone()), MeshMaterial3d(paint.clone())));
    }
}
