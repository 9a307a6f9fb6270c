//! Draws a parasol: its printed cloth, pole, ribs, struts and foot.

use crate::render::{print, stage};
use bevy::prelude::*;

use crate::scenes::parasol::canopy::{self, RIBS};
use crate::scenes::parasol::stand::{HEIGHT, Parasol};

/// Radius of the pole, m.
const POLE: f32 = 0.022;

/// Radius of a rib, m.
const RIB: f32 = 0.008;

/// Distance of the axis of a rib below the cloth, m.
const BELOW: f32 = 0.014;

/// Distance below the top at which the struts meet the pole, m.
const SLIDER: f32 = 0.85;

/// Fraction of a rib's length, from the top, at which the strut meets the rib.
const STRUT: f32 = 0.55;

/// Draws frames and prints the cloths.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth())).add_systems(PostStartup, draw_frames);
}

fn draw_frames(
    mut commands: Commands,
    parasols: Query<Entity, With<Parasol>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let wood = materials.add(StandardMaterial {
        base_color: Color::srgb(0.55, 0.38, 0.23),
        perceptual_roughness: 0.6,
        ..default()
    });
    let stone = materials.add(StandardMaterial {
        base_color: Color::srgb(0.42, 0.42, 0.41),
        perceptual_roughness: 0.9,
        ..default()
    });
    // Cylinders of unit length, which are scaled.
    let [pole, rib] = [POLE, RIB].map(|radius| meshes.add(Cylinder::new(radius, 1.0)));
    let knob = meshes.add(Sphere::new(1.8 * POLE));
    let foot = meshes.add(Cylinder::new(0.26, 0.09));
    let top = HEIGHT * Vec3::Y;
    for parasol in &parasols {
        commands.entity(parasol).insert(Visibility::default()).with_children(|parts| {
            let mut bar = |mesh: &Handle<Mesh>, from: Vec3, to: Vec3| {
                let pose = between(from, to);
                parts.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(wood.clone()), pose));
            };
            bar(&pole, Vec3::ZERO, top);
            for index in 0..RIBS {
                let end = top + canopy::rib_end(index) - BELOW * Vec3::Y;
                let start = top - BELOW * Vec3::Y;
                bar(&rib, start, end);
                bar(&rib, top - SLIDER * Vec3::Y, start.lerp(end, STRUT));
            }
            let knob_pose = Transform::from_translation(top + 1.2 * POLE * Vec3::Y);
            parts.spawn((Mesh3d(knob.clone()), MeshMaterial3d(wood.clone()), knob_pose));
            let foot_pose = Transform::from_xyz(0.0, 0.045, 0.0);
            parts.spawn((Mesh3d(foot.clone()), MeshMaterial3d(stone.clone()), foot_pose));
        });
    }
}

/// The pose and scale of a bar of unit length along y that joins two points.
fn between(from: Vec3, to: Vec3) -> Transform {
    let bar = to - from;
    Transform::from_translation(from.midpoint(to))
        .with_rotation(Quat::from_rotation_arc(Vec3::Y, bar.normalize()))
        .with_scale(Vec3::new(1.0, bar.length(), 1.0))
}
