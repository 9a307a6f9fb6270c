//! What surrounds a scene: sky, ground and light.

use std::f32::consts::FRAC_PI_4;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

use crate::sky;

/// Light from the whole sky, on both sides of everything, cd/m².
const SKYLIGHT: f32 = 1_500.0;

/// Light of the sun, lx.
const SUNLIGHT: f32 = 5_000.0;

/// The plugin that shows what surrounds a scene.
#[derive(Clone, Resource)]
pub struct Stage {
    /// Colour of the ground.
    pub ground: Color,
    /// Width of the ground, m.
    pub extent: f32,
    /// Distances at which haze begins, and hides all else, m: the ground ends where the sky begins.
    pub haze: [f32; 2],
    /// Vertical field of view, rad.
    pub field_of_view: f32,
    /// Whence the sun shines.
    pub sun: Vec3,
    /// Cascades of the shadows.
    pub cascades: usize,
    /// Distances at which the first cascade and the shadows end, m.
    pub shadows: [f32; 2],
}

impl Stage {
    /// For a scene of some metres.
    pub const SMALL: Self = Self {
        ground: Color::srgb(0.60, 0.56, 0.49),
        extent: 1000.0,
        haze: [40.0, 400.0],
        field_of_view: FRAC_PI_4,
        sun: Vec3::new(-1.0, 1.4, 1.1),
        cascades: 2,
        shadows: [8.0, 30.0],
    };

    /// What a camera needs to show it well.
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
        let everywhere = GlobalAmbientLight { color: skylight, brightness: SKYLIGHT, ..default() };
        app.add_plugins(sky::plugin)
            .insert_resource(everywhere)
            .insert_resource(self.clone())
            .add_systems(Startup, (pave, light));
    }
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

/// Cloth of a flag, which is smoother.
#[must_use]
pub fn bunting() -> StandardMaterial {
    StandardMaterial { perceptual_roughness: 0.8, reflectance: 0.25, ..cloth() }
}

/// Paint of poles and masts.
#[must_use]
pub fn paint() -> StandardMaterial {
    StandardMaterial {
        base_color: Color::srgb(0.85, 0.86, 0.87),
        perceptual_roughness: 0.35,
        ..default()
    }
}

fn pave(
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

fn light(mut commands: Commands, stage: Res<Stage>) {
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
