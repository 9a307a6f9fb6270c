//! Draws vehicles from their glTF files.

use bevy::gltf::GltfAssetLabel;
use bevy::prelude::*;
use bunting_scenes::Model;

/// Gives each entity with a [`Model`] the first scene of that file.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, load_vehicles);
}

fn load_vehicles(
    mut commands: Commands,
    vehicles: Query<(Entity, &Model)>,
    assets: Res<AssetServer>,
) {
    for (vehicle, Model(file)) in &vehicles {
        let scene = assets.load(GltfAssetLabel::Scene(0).from_asset(file.clone()));
        commands.entity(vehicle).insert(WorldAssetRoot(scene));
    }
}
