//! The cut of clothes: tubes about the body, closed or open in front.

use std::f32::consts::TAU;

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// A tube about the body, in the figure's frame at rest.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// Ellipses from top to bottom, each with its height and half its extent across and from front to back, m.
    pub rings: &'static [[f32; 3]],
    /// Angle at which it is open in front, rad; 0 for a closed tube.
    pub opening: f32,
    /// Columns and rows of drawn vertices.
    pub vertices: [u32; 2],
    /// Height above which it is held, m.
    pub held_above: f32,
}

impl Cut {
    /// The mesh. The first and the last column of a closed tube coincide.
    pub fn mesh(&self) -> ClothMesh {
        let [columns, rows] = self.vertices;
        let nodes = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let uv = |(row, column): (u32, u32)| {
            Vec2::new(column as f32 / (columns - 1) as f32, row as f32 / (rows - 1) as f32)
        };
        let is_closed = self.opening == 0.0;
        let position = |(row, column): (u32, u32)| {
            let column = if is_closed { column % (columns - 1) } else { column };
            self.place(uv((row, column)))
        };
        let cells = (1..rows).flat_map(|below| (1..columns).map(move |right| (below, right)));
        let indices = cells.flat_map(|(below, right)| {
            let [b, d] = [below - 1, below].map(|row| row * columns + right);
            let [a, c] = [b - 1, d - 1];
            if (below + right).is_multiple_of(2) { [a, c, d, a, d, b] } else { [a, c, b, b, c, d] }
        });
        let positions = nodes().map(position).collect();
        ClothMesh::triangles(positions, indices.collect(), nodes().map(uv).collect())
    }

    /// The vertices that are held.
    pub fn held(&self) -> AttachedVertices {
        let low = Vec3::new(f32::MIN, self.held_above, f32::MIN);
        AttachedVertices::InBox { low, high: Vec3::MAX }
    }

    /// Place of a point of the texture: u runs around the body from the front, v from top to bottom.
    fn place(&self, uv: Vec2) -> Vec3 {
        let [height, across, along] = self.ring(uv.y);
        // Leftwards, as seen by the figure, so that the front of the cloth is outside.
        let angle = 0.5 * self.opening + uv.x * (TAU - self.opening);
        Vec3::new(-across * angle.sin(), height, -along * angle.cos())
    }

    /// The ellipse at a part of the length.
    fn ring(&self, part: f32) -> [f32; 3] {
        let lengths =
            || self.rings.windows(2).map(|pair| Vec3::from(pair[0]).distance(Vec3::from(pair[1])));
        let mut left = part * lengths().sum::<f32>();
        for (pair, length) in self.rings.windows(2).zip(lengths()) {
            if left <= length {
                return Vec3::from(pair[0]).lerp(pair[1].into(), left / length).into();
            }
            left -= length;
        }
        self.rings[self.rings.len() - 1]
    }
}
