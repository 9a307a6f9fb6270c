//! Sky, ground and light around a scene.

use std::f32::consts::FRAC_PI_4;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

use crate::render::sky;

/// Luminance of the sky, from all directions, cd/m².
const SKYLIGHT: f32 = 1_500.0;

/// Illuminance of the sun, lx.
const SUNLIGHT: f32 = 5_000.0;

/// The plugin that draws sky, ground and light.
#[derive(Clone, Resource)]
pub struct Stage {
    /// Colour of the ground.
    pub ground: Color,
    /// Width of the ground, m.
    pub extent: f32,
    /// Distances at which haze begins and becomes opaque, m: it hides the edge of the ground.
    pub haze: [f32; 2],
    /// Vertical field of view, rad.
    pub field_of_view: f32,
    /// Position of the sun relative to the origin; only its direction counts.
    pub sun: Vec3,
    /// Number of shadow cascades.
    pub cascades: usize,
    /// Distances at which the first cascade and the last end, m.
    pub shadows: [f32; 2],
}

impl Stage {
    /// The stage of a scene that measures a few metres.
    pub const SMALL: Self = Self {
        ground: Color::srgb(0.60, 0.56, 0.49),
        extent: 1000.0,
        haze: [40.0, 400.0],
        field_of_view: FRAC_PI_4,
        sun: Vec3::new(-1.0, 1.4, 1.1),
        cascades: 2,
        shadows: [8.0, 30.0],
    };

    /// A camera with this stage's field of view and haze.
    #[must_use]
    pub fn camera(&self) -> impl Bundle + use<> {
        let lens = PerspectiveProjection { fov: self.field_of_view, ..default() };
        let [start, end] = self.haze;
        let haze = DistanceFog {
            color: sky::HORIZON,
            falloff: FogFalloff::Linear { start, end },
            ..default()
        };
        (Camera3d::default(), Projection::Perspective(lens), Tonemapping::None, haze)
    }
}

impl Plugin for Stage {
    fn build(&self, app: &mut App) {
        let skylight = Color::srgb(0.80, 0.90, 0.96);
        let ambient = GlobalAmbientLight { color: skylight, brightness: SKYLIGHT, ..default() };
        app.add_plugins(sky::plugin)
            .insert_resource(ambient)
            .insert_resource(self.clone())
            .add_systems(Startup, (spawn_ground, spawn_sun));
    }
}

/// Material of woven cloth: both faces are drawn, and some light passes through.
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

/// Material of flags: smoother.
#[must_use]
pub fn flag_cloth() -> StandardMaterial {
    StandardMaterial { perceptual_roughness: 0.8, reflectance: 0.25, ..cloth() }
}

/// Material of painted poles.
#[must_use]
pub fn paint() -> StandardMaterial {
    StandardMaterial {
        base_color: Color::srgb(0.85, 0.86, 0.87),
        perceptual_roughness: 0.35,
        ..default()
    }
}

fn spawn_ground(
    mut commands: Commands,
    stage: Res<Stage>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let ground = StandardMaterial {
        base_color: stage.ground,
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(stage.extent, stage.extent))),
        MeshMaterial3d(materials.add(ground)),
    ));
}

fn spawn_sun(mut commands: Commands, stage: Res<Stage>) {
    let [first_cascade_far_bound, maximum_distance] = stage.shadows;
    commands.spawn((
        DirectionalLight {
            illuminance: SUNLIGHT,
            color: Color::srgb(1.0, 0.95, 0.86),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: stage.cascades,
            first_cascade_far_bound,
            maximum_distance,
            ..default()
        }
        .build(),
        Transform::from_translation(stage.sun).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}
