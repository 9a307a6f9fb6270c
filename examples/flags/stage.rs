//! What surrounds the flags: sky, ground, roads, light, poles and vehicles.

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::VisibilityClass;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::gltf::{GltfAssetLabel, GltfMaterialName, GltfMeshName, GltfSceneName};
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy::transform::components::TransformTreeChanged;
use bunting_examples::sky;
use bunting_scenes::{Model, Pole, Track};

use crate::road;

/// Light from the whole sky, on both sides of everything, cd/m².
const SKYLIGHT: f32 = 1_500.0;

/// Light of the sun, lx.
const SUNLIGHT: f32 = 5_000.0;

/// Shows the surroundings of a scene's entities.
pub fn plugin(app: &mut App) {
    let skylight = Color::srgb(0.80, 0.90, 0.96);
    app.add_plugins(sky::plugin)
        .insert_resource(GlobalAmbientLight { color: skylight, brightness: SKYLIGHT, ..default() })
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
        .add_systems(Startup, (lay_ground, light))
        .add_systems(PostStartup, (lay_roads, raise_poles, load_vehicles));
}

/// What a camera needs to show the scene well.
pub fn camera() -> impl Bundle {
    // The ground ends where the sky begins.
    let haze = DistanceFog {
        color: sky::HORIZON,
        falloff: FogFalloff::Linear { start: 100.0, end: 700.0 },
        ..default()
    };
    (Camera3d::default(), Tonemapping::None, haze)
}

fn lay_ground(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let grass = StandardMaterial {
        base_color: Color::srgb(0.33, 0.37, 0.24),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(2000.0, 2000.0))),
        MeshMaterial3d(materials.add(grass)),
    ));
}

fn light(mut commands: Commands) {
    commands.spawn((
        DirectionalLight {
            illuminance: SUNLIGHT,
            color: Color::srgb(1.0, 0.95, 0.86),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 3,
            first_cascade_far_bound: 25.0,
            maximum_distance: 140.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(-1.0, 1.0, 0.55).looking_at(Vec3::ZERO, Vec3::Y),
    ));
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
    let paint = materials.add(StandardMaterial {
        base_color: Color::srgb(0.85, 0.86, 0.87),
        perceptual_roughness: 0.35,
        ..default()
    });
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
