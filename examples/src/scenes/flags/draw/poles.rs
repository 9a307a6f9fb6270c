//! Draws flag poles.

use crate::render::stage;
use bevy::prelude::*;
use bunting_scenes::Pole;

/// Gives each [`Pole`] a shaft and a golden ball on its top.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, draw_poles);
}

fn draw_poles(
    mut commands: Commands,
    poles: Query<(Entity, &Pole)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let paint = materials.add(stage::paint());
    let gold = materials.add(StandardMaterial {
        base_color: Color::srgb(0.85, 0.65, 0.25),
        metallic: 0.8,
        perceptual_roughness: 0.35,
        ..default()
    });
    let ball = meshes.add(Sphere::new(2.0 * Pole::RADIUS));
    for (pole, &Pole { height }) in &poles {
        let shaft = meshes.add(Cylinder::new(Pole::RADIUS, height));
        commands.entity(pole).insert(Visibility::default()).with_children(|parts| {
            let middle = Transform::from_xyz(0.0, 0.5 * height, 0.0);
            parts.spawn((Mesh3d(shaft), MeshMaterial3d(paint.clone()), middle));
            let top = Transform::from_xyz(0.0, height, 0.0);
            parts.spawn((Mesh3d(ball.clone()), MeshMaterial3d(gold.clone()), top));
        });
    }
}
