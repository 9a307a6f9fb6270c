//! What surrounds the cloths: sky, ground, light and poles.

use std::f32::consts::FRAC_PI_3;

use bevy::prelude::*;

use bunting_examples::stage::{self, Stage};

use crate::plaza::Mast;

/// The plaza at noon.
pub const STAGE: Stage = Stage {
    ground: Color::srgb(0.52, 0.50, 0.46),
    extent: 2000.0,
    haze: [100.0, 700.0],
    field_of_view: FRAC_PI_3,
    sun: Vec3::new(-1.0, 1.0, 0.55),
    cascades: 2,
    shadows: [20.0, 80.0],
};

/// Shows the surroundings.
pub fn plugin(app: &mut App) {
    app.add_plugins(STAGE).add_systems(PostStartup, raise_masts);
}

/// All masts are one mesh, scaled.
fn raise_masts(
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
