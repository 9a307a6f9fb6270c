//! Draws the rail and prints the towels.

use crate::render::{print, stage};
use bevy::prelude::*;

use crate::scenes::towel::rail::{RAIL, RAIL_SIZE};

/// Draws the rail and prints the towels.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth())).add_systems(PostStartup, draw_rail);
}

fn draw_rail(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let steel = materials.add(StandardMaterial {
        base_color: Color::srgb(0.55, 0.56, 0.58),
        metallic: 0.4,
        perceptual_roughness: 0.35,
        ..default()
    });
    let [half, radius] = RAIL_SIZE;
    let mut spawn = |mesh: Mesh, place: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(steel.clone()), place));
    };
    let along_rail = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let rail = Transform::from_translation(RAIL).with_rotation(along_rail);
    spawn(Capsule3d::new(radius, 2.0 * half).into(), rail);
    for side in [-half, half] {
        let post = Vec3::new(RAIL.x + side, 0.5 * RAIL.y, RAIL.z);
        spawn(Cylinder::new(radius, RAIL.y).into(), Transform::from_translation(post));
    }
}
