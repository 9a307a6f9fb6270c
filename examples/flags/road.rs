//! Roads where vehicles drive.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bunting_scenes::Track;

/// Half the width of a road, m.
const HALF_WIDTH: f32 = 2.4;

/// Height above the ground, m: enough for the depth buffer to tell them apart from afar.
const HEIGHT: f32 = 0.03;

/// Length of a piece of road, m.
const PIECE: f64 = 2.0;

/// A flat ribbon along a closed track.
pub fn ribbon(track: &Track) -> Mesh {
    let pieces = (track.length() / PIECE) as u32;
    let mut positions = Vec::new();
    for piece in 0..pieces {
        let pose = track.pose_at(track.length() * f64::from(piece) / f64::from(pieces));
        for side in [-HALF_WIDTH, HALF_WIDTH] {
            positions.push(pose.transform_point(Vec3::new(side, HEIGHT, 0.0)));
        }
    }
    let indices = (0..pieces).flat_map(|piece| {
        let (left, right) = (2 * piece, 2 * piece + 1);
        let (next_left, next_right) = (2 * ((piece + 1) % pieces), 2 * ((piece + 1) % pieces) + 1);
        [left, right, next_left, next_left, right, next_right]
    });
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_indices(Indices::U32(indices.collect()))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Y; positions.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}
