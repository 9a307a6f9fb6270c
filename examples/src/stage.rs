//! What surrounds a small scene: sky, ground and light.

use std::f32::consts::FRAC_PI_4;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

use crate::sky;

/// Light from the whole sky, on both sides of everything, cd/m².
const SKYLIGHT: f32 = 1_500.0;

/// Light of the sun, lx.
const SUNLIGHT: f32 = 5_000.0;

/// Shows the surroundings.
pub fn plugin(app: &mut App) {
    let skylight = Color::srgb(0.80, 0.90, 0.96);
    app.add_plugins(sky::plugin)
        .insert_resource(GlobalAmbientLight { color: skylight, brightness: SKYLIGHT, ..default() })
        .add_systems(Startup, (pave, light));
}

/// What a camera needs to show them well.
#[must_use]
pub fn camera() -> impl Bundle {
    let lens = PerspectiveProjection { fov: FRAC_PI_4, ..default() };
    let haze = DistanceFog {
        color: sky::HORIZON,
        falloff: FogFalloff::Linear { start: 40.0, end: 400.0 },
        ..default()
    };
    (Camera3d::default(), Projection::Perspective(lens), Tonemapping::None, haze)
}

/// Cloth of a colour, or of a printed one: light shines through it, and both faces are seen.
#[must_use]
pub fn cloth() -> StandardMaterial {
    StandardMaterial {
        double_sided: true,
        cull_mode: None,
        perceptual_roughness: 0.9,
        reflectance: 0.2,
        diffuse_transmission: 0.25,
        ..default()
    }
}

fn pave(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let stone = StandardMaterial {
        base_color: Color::srgb(0.60, 0.56, 0.49),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(1000.0, 1000.0))),
        MeshMaterial3d(materials.add(stone)),
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
            num_cascades: 2,
            first_cascade_far_bound: 8.0,
            maximum_distance: 30.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(-1.0, 1.4, 1.1).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}
