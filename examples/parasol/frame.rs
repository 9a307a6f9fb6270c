//! What holds the cloth of a parasol: pole, ribs, struts and foot; and what it is printed with.

use bevy::prelude::*;
use bunting_examples::{print, stage};
use bunting_scenes::Design;

use crate::canopy::{self, RIBS};
use crate::{Canopy, HEIGHT, Parasol};

/// Radius of the pole, m.
const POLE: f32 = 0.022;

/// Radius of a rib, m.
const RIB: f32 = 0.008;

/// How far below the cloth a rib is, m.
const BELOW: f32 = 0.014;

/// How far below the top the struts meet the pole, m.
const SLIDER: f32 = 0.85;

/// Where a strut meets its rib, as a part of the rib.
const STRUT: f32 = 0.55;

/// Colour of every other panel.
const CREAM: [u8; 3] = [238, 232, 214];

/// Builds frames and prints cloth.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, (build, print_cloth));
}

fn build(
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
    // Of unit length, to be scaled.
    let [pole, rib] = [POLE, RIB].map(|radius| meshes.add(Cylinder::new(radius, 1.0)));
    let knob = meshes.add(Sphere::new(1.8 * POLE));
    let foot = meshes.add(Cylinder::new(0.26, 0.09));
    let top = HEIGHT * Vec3::Y;
    for parasol in &parasols {
        commands.entity(parasol).insert(Visibility::default()).with_children(|parts| {
            let mut bar = |mesh: &Handle<Mesh>, from: Vec3, to: Vec3| {
                let place = between(from, to);
                parts.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(wood.clone()), place));
            };
            bar(&pole, Vec3::ZERO, top);
            for index in 0..RIBS {
                let end = top + canopy::rib_end(index) - BELOW * Vec3::Y;
                let start = top - BELOW * Vec3::Y;
                bar(&rib, start, end);
                bar(&rib, top - SLIDER * Vec3::Y, start.lerp(end, STRUT));
            }
            let knob_place = Transform::from_translation(top + 1.2 * POLE * Vec3::Y);
            parts.spawn((Mesh3d(knob.clone()), MeshMaterial3d(wood.clone()), knob_place));
            let foot_place = Transform::from_xyz(0.0, 0.045, 0.0);
            parts.spawn((Mesh3d(foot.clone()), MeshMaterial3d(stone.clone()), foot_place));
        });
    }
}

/// Puts a bar of unit length along y between two points.
fn between(from: Vec3, to: Vec3) -> Transform {
    let way = to - from;
    Transform::from_translation(from.midpoint(to))
        .with_rotation(Quat::from_rotation_arc(Vec3::Y, way.normalize()))
        .with_scale(Vec3::new(1.0, way.length(), 1.0))
}

fn print_cloth(
    mut commands: Commands,
    canopies: Query<(Entity, &Canopy)>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (cloth, Canopy(parasol)) in &canopies {
        let colours = (0..RIBS).map(|panel| if panel % 2 == 0 { parasol.colour } else { CREAM });
        let design = Design::Pales(colours.collect());
        let picture = images.add(print::picture(&design, Vec2::new(8.0, 0.1)));
        let material = StandardMaterial { base_color_texture: Some(picture), ..stage::cloth() };
        commands.entity(cloth).insert(MeshMaterial3d(materials.add(material)));
    }
}
