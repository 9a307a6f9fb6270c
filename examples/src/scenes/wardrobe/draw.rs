//! Draws the body and the stool, and prints the clothes.

use bevy::prelude::*;

use crate::figure::part::Part;
use crate::figure::skeleton::Joint;
use crate::figure::walker::Walker;
use crate::render::{print, stage};
use crate::scenes::wardrobe::room::{HEIGHT, RADIUS, Stool};

/// Draws everything that is no cloth, and prints the clothes.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth()))
        .add_systems(PostStartup, (draw_body, draw_stool));
}

fn draw_body(
    parts: Query<(Entity, &Part)>,
    figure: Single<Entity, With<Walker>>,
    joints: Query<Entity, With<Joint>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let skin = materials.add(StandardMaterial {
        base_color: Color::srgb(0.80, 0.66, 0.55),
        perceptual_roughness: 0.7,
        ..default()
    });
    for entity in joints.iter().chain([*figure]) {
        commands.entity(entity).insert(Visibility::default());
    }
    for (entity, part) in &parts {
        let capsule = meshes.add(Capsule3d::new(part.radius, 2.0 * part.half_length()));
        commands.entity(entity).insert((Mesh3d(capsule), MeshMaterial3d(skin.clone())));
    }
}

fn draw_stool(
    stool: Single<Entity, With<Stool>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let wood = materials.add(StandardMaterial {
        base_color: Color::srgb(0.55, 0.38, 0.23),
        perceptual_roughness: 0.6,
        ..default()
    });
    let drum = meshes.add(Cylinder::new(RADIUS, HEIGHT));
    commands.entity(*stool).insert((Mesh3d(drum), MeshMaterial3d(wood)));
}
