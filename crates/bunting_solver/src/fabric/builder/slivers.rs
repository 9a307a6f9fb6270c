//! Removes triangles that are almost lines from a simplified mesh.
//!
//! If all vertices of a straight border are kept, three of them may end up as one triangle. Flipping the edge
//! that this triangle shares with its neighbour gives two sound triangles.

use std::collections::BTreeMap;

use glam::Vec3;

/// Area over the square of the longest edge below which a triangle is a sliver; 0.43 is equilateral. Smaller: stiff
/// needles remain. Larger: edges are flipped against the shape of the surface.
const SLIVER: f32 = 0.03;

/// Flips the longest edges of slivers as long as this improves the worse of the two triangles, and makes no edge that there
/// is already.
pub(super) fn flip_slivers(
    positions: &[Vec3],
    particle_of_vertex: &[u32],
    triangles: &mut [[u32; 3]],
) {
    let particle = |vertex: u32| particle_of_vertex[vertex as usize];
    let shape = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let edges = [b - a, c - b, a - c].map(Vec3::length_squared);
        0.5 * (b - a).cross(c - a).length() / edges.into_iter().fold(f32::MIN_POSITIVE, f32::max)
    };
    // Each flip improves a pair of triangles, so that one flip per triangle is enough for any sensible mesh.
    for _ in 0..triangles.len() {
        let mut at_edge = BTreeMap::new();
        for (index, &[a, b, c]) in triangles.iter().enumerate() {
            at_edge.extend([((a, b), index), ((b, c), index), ((c, a), index)]);
        }
        let flip = triangles.iter().enumerate().find_map(|(index, &triangle)| {
            if shape(triangle) >= SLIVER {
                return None;
            }
            let [from, to, tip] = longest_edge_first(positions, triangle);
            let other = *at_edge.get(&(to, from))?;
            let opposite = *triangles[other].iter().find(|&&at| at != from && at != to)?;
            let new = [[tip, from, opposite], [opposite, to, tip]];
            let worst = |pair: [[u32; 3]; 2]| pair.map(shape).into_iter().fold(f32::MAX, f32::min);
            let has = |corners: &[u32; 3], vertex: u32| {
                corners.iter().any(|&at| particle(at) == particle(vertex))
            };
            let is_edge = || triangles.iter().any(|it| has(it, tip) && has(it, opposite));
            let improves = worst(new) > worst([triangle, triangles[other]]);
            (improves && !is_edge()).then_some((index, other, new))
        });
        let Some((index, other, new)) = flip else { break };
        [triangles[index], triangles[other]] = new;
    }
}

fn longest_edge_first(positions: &[Vec3], [a, b, c]: [u32; 3]) -> [u32; 3] {
    let length = |from: u32, to: u32| positions[from as usize].distance(positions[to as usize]);
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    let longest = turns
        .into_iter()
        .max_by(|one, other| length(one[0], one[1]).total_cmp(&length(other[0], other[1])));
    longest.unwrap_or([a, b, c])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_of_a_triangle_on_a_straight_border_is_flipped() {
        let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let positions = [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(1.0, 1.5)];
        // Vertices 0, 1 and 2 lie on one line; the second triangle shares the edge from 0 to 2.
        let mut triangles = [[0, 1, 2], [0, 2, 3]];
        flip_slivers(&positions, &[0, 1, 2, 3], &mut triangles);
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| positions[corner as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!(triangles.into_iter().all(|triangle| area(triangle) > 0.7), "{triangles:?}");
    }

    #[test]
    fn no_edge_is_made_twice() {
        let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let positions = [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(1.0, 1.5), at(1.5, 0.7)];
        // A further layer has an edge from 1 to 3.
        let given = [[0, 1, 2], [0, 2, 3], [1, 4, 3]];
        let mut triangles = given;
        flip_slivers(&positions, &[0, 1, 2, 3, 4], &mut triangles);
        assert_eq!(triangles, given);
    }
}
