//! Delaunay triangles of points in the plane (Bowyer 1981, Watson 1981), for a few thousand points.

use std::collections::BTreeSet;

use glam::DVec2;

/// Least doubled area of a triangle. Smaller: points on a straight border are joined by triangles without area.
const LEAST_AREA: f64 = 1e-7;
/// Least value at which a point is inside a circle. Smaller: rounding of four points on a circle.
const INSIDE: f64 = 1e-9;

/// Three points per triangle, counter-clockwise. Coordinates are of the order of one to a hundred.
#[must_use]
pub fn triangulate(points: &[DVec2]) -> Vec<[usize; 3]> {
    let count = points.len();
    let mut points = points.to_vec();
    // A triangle around all points, whose corners are left out in the end.
    points.extend([[-1e4, -1e4], [1e4, -1e4], [0.0, 1.5e4]].map(DVec2::from));
    let mut triangles = vec![[count, count + 1, count + 2]];
    for new in 0..count {
        let (around, kept): (Vec<_>, Vec<_>) = triangles
            .into_iter()
            .partition(|&triangle| in_circle(triangle.map(|at| points[at]), points[new]));
        triangles = kept;
        let sides = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
        let sides: BTreeSet<[usize; 2]> = around.iter().flat_map(sides).collect();
        let outer = sides.iter().filter(|[a, b]| !sides.contains(&[*b, *a]));
        triangles.extend(outer.map(|&[a, b]| [a, b, new]));
    }
    triangles.retain(|triangle| {
        triangle.iter().all(|&at| at < count) && area(triangle.map(|at| points[at])) > LEAST_AREA
    });
    triangles
}

/// Twice the area.
fn area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether a point lies in the circle through the corners of a triangle.
fn in_circle(corners: [DVec2; 3], point: DVec2) -> bool {
    let [a, b, c] =
        corners.map(|corner| (corner - point).extend((corner - point).length_squared()));
    a.dot(b.cross(c)) > INSIDE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_lies_in_the_circle_of_a_triangle() {
        let points: Vec<DVec2> = (0..60)
            .map(|index| f64::from(index) + 1.0)
            .map(|index| DVec2::new((index * 7.31) % 10.0, (index * index * 3.17) % 10.0))
            .collect();
        let triangles = triangulate(&points);
        assert!(triangles.len() > 60);
        for triangle in triangles {
            let corners = triangle.map(|at| points[at]);
            assert!(area(corners) > 0.0);
            assert!(!points.iter().any(|&point| in_circle(corners, point)));
        }
    }
}
