//! What surrounds the cloths: sky, ground, light and poles.

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

use bunting_examples::sky;

use crate::plaza::Mast;

/// Light from the whole sky, on both sides of everything, cd/m².
const SKYLIGHT: f32 = 1_500.0;

/// Light of the sun, lx.
const SUNLIGHT: f32 = 5_000.0;

/// Shows the surroundings.
pub fn plugin(app: &mut App) {
    let skylight = Color::srgb(0.80, 0.90, 0.96);
    app.add_plugins(sky::plugin)
        .insert_resource(GlobalAmbientLight { color: skylight, brightness: SKYLIGHT, ..default() })
        .add_systems(Startup, (pave, light))
        .add_systems(PostStartup, raise_masts);
}

/// What a camera needs to show the plaza well.
pub fn camera() -> impl Bundle {
    let lens = PerspectiveProjection { fov: std::f32::consts::FRAC_PI_3, ..default() };
    let haze = DistanceFog {
        color: sky::HORIZON,
        falloff: FogFalloff::Linear { start: 100.0, end: 700.0 },
        ..default()
    };
    (Camera3d::default(), Projection::Perspective(lens), Tonemapping::None, haze)
}

fn pave(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let stone = StandardMaterial {
        base_color: Color::srgb(0.52, 0.50, 0.46),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(2000.0, 2000.0))),
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
            first_cascade_far_bound: 20.0,
            maximum_distance: 80.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(-1.0, 1.0, 0.55).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

/// All masts are one mesh, scaled.
fn raise_masts(
    mut commands: Commands,
    masts: Query<(Entity, &Mast)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let shaft = meshes.add(Cylinder::new(Mast::RADIUS, 1.0).mesh().resolution(8));
    let paint = materials.add(StandardMaterial {
        base_color: Color::srgb(0.85, 0.86, 0.87),
        perceptual_roughness: 0.35,
        ..default()
    });
    for (mast, &Mast(height)) in &masts {
        let middle = Transform::from_xyz(0.0, 0.5 * height, 0.0);
        let shape = middle.with_scale(Vec3::new(1.0, height, 1.0));
        commands.entity(mast).insert(Visibility::default()).with_children(|parts| {
            parts.spawn((Mesh3d(shaft.clone()), MeshMaterial3d(paint.clone()), shape));
        });
    }
}
