//! Draws the roads on which vehicles drive.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bunting_scenes::{Model, Track};

/// Half the width of a road, m.
const HALF_WIDTH: f32 = 2.4;

/// Height above the ground, m. Smaller: road and ground have equal depths from afar and flicker.
const HEIGHT: f32 = 0.03;

/// Length of a segment of road, m.
const SEGMENT: f64 = 2.0;

/// Lays a road along the track of each vehicle.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, draw_roads);
}

fn draw_roads(
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
        commands.spawn((Mesh3d(meshes.add(ribbon(track))), MeshMaterial3d(asphalt.clone())));
    }
}

/// A flat ribbon along a closed track.
fn ribbon(track: &Track) -> Mesh {
    let segments = (track.length() / SEGMENT) as u32;
    let mut positions = Vec::new();
    for segment in 0..segments {
        let pose = track.pose_at(track.length() * f64::from(segment) / f64::from(segments));
        for side in [-HALF_WIDTH, HALF_WIDTH] {
            positions.push(pose.transform_point(Vec3::new(side, HEIGHT, 0.0)));
        }
    }
    let indices = (0..segments).flat_map(|segment| {
        let [left, right] = [2 * segment, 2 * segment + 1];
        let next = 2 * ((segment + 1) % segments);
        let [next_left, next_right] = [next, next + 1];
        [left, right, next_left, next_left, right, next_right]
    });
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_indices(Indices::U32(indices.collect()))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Y; positions.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}
