//! The sky: a dome, pale at the horizon and blue at the zenith.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;

/// Colour at the horizon, and of distant haze.
pub const HORIZON: Color = Color::srgb(0.74, 0.82, 0.89);

/// Colour at the zenith.
const ZENITH: Color = Color::srgb(0.22, 0.44, 0.74);

/// Radius of the dome, m: beyond the haze, and nearer than the camera's far plane.
const RADIUS: f32 = 900.0;

/// Adds the dome.
pub fn plugin(app: &mut App) {
    app.insert_resource(ClearColor(HORIZON)).add_systems(Startup, spawn_dome);
}

fn spawn_dome(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut dome = Sphere::new(RADIUS).mesh().uv(48, 32);
    let positions = dome.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|values| values.as_float3());
    let colours: Vec<[f32; 4]> = positions
        .expect("a sphere has positions")
        .iter()
        .map(|&[_, height, _]| colour(height / RADIUS).to_f32_array())
        .collect();
    dome.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
    let air = StandardMaterial { unlit: true, fog_enabled: false, cull_mode: None, ..default() };
    commands.spawn((Mesh3d(meshes.add(dome)), MeshMaterial3d(materials.add(air)), NotShadowCaster));
}

/// Colour at the given sine of the angle above the horizon.
fn colour(sine: f32) -> LinearRgba {
    let [horizon, zenith] = [HORIZON, ZENITH].map(LinearRgba::from);
    horizon.mix(&zenith, sine.max(0.0).sqrt())
}
