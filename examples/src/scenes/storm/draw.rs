//! Draws masts, the road and the truck, and prints the flags.

use crate::render::stage::Stage;
use crate::render::{print, stage};
use bevy::gltf::GltfAssetLabel;
use bevy::prelude::*;
use bunting_scenes::Model;

use crate::scenes::storm::field::Mast;
use crate::scenes::storm::weather::Truck;

/// Sky, ground and light of a wide field.
pub const STAGE: Stage = Stage::SMALL;

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
    assets: Res<AssetServer>,
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
    for truck in &trucks {
        let model = Model("vehicles/truck.glb".to_owned());
        let scene = assets.load(GltfAssetLabel::Scene(0).from_asset(model.0.clone()));
        let on_road = Transform::from_xyz(0.0, -Truck::HEIGHT, 0.0).looking_to(Vec3::X, Vec3::Y);
        let shown = (model, WorldAssetRoot(scene), on_road);
        commands.entity(truck).insert(Visibility::default()).with_child(shown);
    }
}
