//! Pairs of triangles that intersect, counted with exact predicates and without code of the product.
//!
//! Two triangles intersect where an edge of one passes through the other. Pairs that share an edge are left out: they
//! touch there in any case.

use glam::Vec3;
use robust::{Coord3D, orient3d};

/// Number of pairs of triangles that intersect beyond the particles that they share. Positions are in m.
pub(super) fn intersecting_pairs(triangles: &[[u32; 3]], positions: &[Vec3]) -> usize {
    let mut boxes: Vec<(Vec3, Vec3, [u32; 3])> = triangles
        .iter()
        .map(|&triangle| {
            let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
            (a.min(b).min(c), a.max(b).max(c), triangle)
        })
        .collect();
    boxes.sort_by(|one, other| one.0.x.total_cmp(&other.0.x));
    let mut count = 0;
    for (index, (low, high, triangle)) in boxes.iter().enumerate() {
        for (other_low, other_high, other) in &boxes[index + 1..] {
            if other_low.x >= high.x {
                break;
            }
            // Boxes that only touch are apart, too.
            let apart = low.cmpge(*other_high) | other_low.cmpge(*high);
            if !apart.any() && intersect(*triangle, *other, positions) {
                count += 1;
            }
        }
    }
    count
}

/// Whether an edge of one triangle passes through the other, and has no particle in common with it.
fn intersect(one: [u32; 3], other: [u32; 3], positions: &[Vec3]) -> bool {
    if one.iter().filter(|corner| other.contains(corner)).count() > 1 {
        return false;
    }
    let crosses = |[a, b, c]: [u32; 3], triangle: [u32; 3]| {
        [[a, b], [b, c], [c, a]].into_iter().any(|edge| {
            edge.iter().all(|end| !triangle.contains(end)) && passes(edge, triangle, positions)
        })
    };
    crosses(one, other) || crosses(other, one)
}

/// Whether an edge passes through a triangle: its ends lie on different sides of the plane, and its line turns the same
/// way about all three sides.
fn passes(edge: [u32; 2], triangle: [u32; 3], positions: &[Vec3]) -> bool {
    if is_beside(edge, triangle, positions) {
        return false;
    }
    let at = |corner: u32| {
        let [x, y, z] = positions[corner as usize].as_dvec3().to_array();
        Coord3D { x, y, z }
    };
    let ([p, q], [a, b, c]) = (edge.map(at), triangle.map(at));
    if orient3d(a, b, c, p) * orient3d(a, b, c, q) >= 0.0 {
        return false;
    }
    let turns = [orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)];
    turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0)
}

/// Whether an edge lies beyond one side of a triangle, seen along the normal, by more than rounding. Exact predicates take
/// long on triangles in one plane, which most neighbours are.
fn is_beside(edge: [u32; 2], triangle: [u32; 3], positions: &[Vec3]) -> bool {
    /// Least distance from the side, m.
    const LEAST: f64 = 1e-9;
    let at = |corner: u32| positions[corner as usize].as_dvec3();
    let ([p, q], [a, b, c]) = (edge.map(at), triangle.map(at));
    let normal = (b - a).cross(c - a);
    [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| {
        let outwards = (to - from).cross(normal);
        let least = LEAST * outwards.length();
        (p - from).dot(outwards) > least && (q - from).dot(outwards) > least
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle in the plane z = 0, and one that stands upon it or passes through it.
    fn pair_at(height: f32) -> usize {
        let positions = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::new(0.2, 0.2, height),
            Vec3::new(0.3, 0.2, height + 1.0),
            Vec3::new(0.2, 0.3, height + 1.0),
        ];
        intersecting_pairs(&[[0, 1, 2], [3, 4, 5]], &positions)
    }

    #[test]
    fn triangles_intersect_where_an_edge_passes_through() {
        assert_eq!((pair_at(0.001), pair_at(-0.001)), (0, 1));
    }

    #[test]
    fn triangles_with_a_common_corner_intersect_by_the_opposite_edges() {
        let positions = |height: f32| {
            [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.5, 0.2, height), Vec3::new(0.5, 0.4, 1.0)]
        };
        let triangles = [[0, 1, 2], [0, 3, 4]];
        let counts = [0.1, -0.1].map(|height| intersecting_pairs(&triangles, &positions(height)));
        assert_eq!(counts, [0, 1]);
    }
}
