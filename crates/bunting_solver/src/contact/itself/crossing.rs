//! Edges that pass through triangles.

use glam::Vec3;

use crate::contact::itself::pairs::EdgeTriangle;

/// Where an edge passes through a triangle.
pub(in crate::contact) struct Crossing {
    /// Fraction of the edge's length.
    pub along: f32,
    /// Barycentric coordinates in the triangle.
    pub coordinates: [f32; 3],
}

/// Where an edge passes through a triangle, given the positions of all particles; none if it does not.
pub(in crate::contact) fn crossing(pair: &EdgeTriangle, positions: &[Vec3]) -> Option<Crossing> {
    let [p, q] = pair.edge.map(|end| positions[end as usize]);
    let [a, b, c] = pair.triangle.map(|corner| positions[corner as usize]);
    let (first, second, from) = (b - a, c - a, p - a);
    let normal = first.cross(second);
    let heights = [normal.dot(from), normal.dot(q - a)];
    if heights[0] * heights[1] > 0.0 || heights[0] == heights[1] {
        return None;
    }
    // Signed volumes over the sides: the edge's line turns the same way about all of them.
    let edge = q - p;
    let [pa, pb, pc] = [a - p, b - p, c - p];
    let turns = [edge.dot(pb.cross(pc)), edge.dot(pc.cross(pa)), edge.dot(pa.cross(pb))];
    let same = turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0);
    let sum: f32 = turns.iter().sum();
    (same && sum != 0.0).then(|| Crossing {
        along: heights[0] / (heights[0] - heights[1]),
        coordinates: turns.map(|turn| turn / sum),
    })
}
