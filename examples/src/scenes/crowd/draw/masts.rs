//! Draws masts.

use crate::render::stage;
use bevy::prelude::*;

use crate::scenes::crowd::plaza::Mast;

/// Gives each [`Mast`] a shaft: one shared mesh, scaled.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, draw_masts);
}

fn draw_masts(
    mut commands: Commands,
    masts: Query<(Entity, &Mast)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let shaft = meshes.add(Cylinder::new(Mast::RADIUS, 1.0).mesh().resolution(8));
    let paint = materials.add(stage::paint());
    for (mast, &Mast(height)) in &masts {
        let middle = Transform::from_xyz(0.0, 0.5 * height, 0.0);
        let shape = middle.with_scale(Vec3::new(1.0, height, 1.0));
        commands.entity(mast).insert(Visibility::default()).with_children(|parts| {
            parts.spawn((Mesh3d(shaft.clone()), MeshMaterial3d(paint.clone()), shape));
        });
    }
}
