//! What surrounds the flags: sky, ground, roads, light, poles and vehicles.

use std::f32::consts::FRAC_PI_4;

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::VisibilityClass;
use bevy::gltf::{GltfAssetLabel, GltfMaterialName, GltfMeshName, GltfSceneName};
use bevy::prelude::*;
use bevy::transform::components::TransformTreeChanged;
use bunting_examples::stage::{self, Stage};
use bunting_scenes::{Model, Pole, Track};

use crate::road;

/// A meadow in the morning.
pub const STAGE: Stage = Stage {
    ground: Color::srgb(0.33, 0.37, 0.24),
    extent: 2000.0,
    haze: [100.0, 700.0],
    field_of_view: FRAC_PI_4,
    sun: Vec3::new(-1.0, 1.0, 0.55),
    cascades: 3,
    shadows: [25.0, 140.0],
};

/// Shows the surroundings of a scene's entities.
pub fn plugin(app: &mut App) {
    app.add_plugins(STAGE)
        // What glTF scenes are made of; Bevy's feature `reflect_auto_register` would do it, too.
        .register_type::<Name>()
        .register_type::<ChildOf>()
        .register_type::<Children>()
        .register_type::<Transform>()
        .register_type::<GlobalTransform>()
        .register_type::<TransformTreeChanged>()
        .register_type::<Visibility>()
        .register_type::<InheritedVisibility>()
        .register_type::<ViewVisibility>()
        .register_type::<VisibilityClass>()
        .register_type::<Aabb>()
        .register_type::<Mesh3d>()
        .register_type::<GltfSceneName>()
        .register_type::<GltfMeshName>()
        .register_type::<GltfMaterialName>()
        .add_systems(PostStartup, (lay_roads, raise_poles, load_vehicles));
}

fn lay_roads(
    mut commands: Commands,
    vehicles: Query<&Track, With<Model>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let asphalt = materials.add(StandardMaterial {
        base_color: Color::srgb(0.22, 0.22, 0.23),
        perceptual_roughness: 0.95,
        reflectance: 0.2,
        ..default()
    });
    for track in &vehicles {
        commands.spawn((Mesh3d(meshes.add(road::ribbon(track))), MeshMaterial3d(asphalt.clone())));
    }
}

fn raise_poles(
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

fn load_vehicles(
    mut commands: Commands,
    vehicles: Query<(Entity, &Model)>,
    assets: Res<AssetServer>,
) {
    for (vehicle, Model(file)) in &vehicles {
        let body = assets.load(GltfAssetLabel::Scene(0).from_asset(file.clone()));
        commands.entity(vehicle).insert(WorldAssetRoot(body));
    }
}
