//! Closest points of edges, and a particle over a triangle.

use glam::Vec3;

use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};

/// Squared sine of the angle between two edges from which on they are not parallel. Smaller: rounding errors choose the
/// points. Larger: edges that nearly point along each other are not met at their closest points.
const LEAST_SQUARED_SINE: f32 = 1e-6;

/// Parameters from 0 to 1 of the closest points of two edges (Ericson 2005, "Real-time collision detection", 5.1.9).
pub(in crate::contact) fn edges([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> [f32; 2] {
    let (one, other, between) = (b - a, d - c, a - c);
    let (squared_one, squared_other) = (one.length_squared(), other.length_squared());
    let (along_one, along_other) = (one.dot(between), other.dot(between));
    if squared_one <= LEAST_LENGTH || squared_other <= LEAST_LENGTH {
        return [0.0, 0.0];
    }
    let both = one.dot(other);
    let determinant = squared_one * squared_other - both * both;
    let first = if determinant > LEAST_SQUARED_SINE * squared_one * squared_other {
        ((both * along_other - along_one * squared_other) / determinant).clamp(0.0, 1.0)
    } else {
        0.5
    };
    let second = (both * first + along_other) / squared_other;
    if second < 0.0 {
        [(-along_one / squared_one).clamp(0.0, 1.0), 0.0]
    } else if second > 1.0 {
        [((both - along_one) / squared_one).clamp(0.0, 1.0), 1.0]
    } else {
        [first, second]
    }
}

/// A point over or under a triangle.
pub(in crate::contact) struct Over {
    /// Unit normal of the triangle.
    pub normal: Vec3,
    /// Signed distance of the point from the plane, m.
    pub height: f32,
    /// Barycentric coordinates of the point's projection.
    pub coordinates: [f32; 3],
}

impl Over {
    /// Whether the point is projected into the triangle.
    pub fn is_inside(&self) -> bool {
        self.coordinates.iter().all(|&coordinate| coordinate >= 0.0)
    }
}

/// A point relative to a triangle; none of a collapsed triangle.
pub(in crate::contact) fn over(point: Vec3, [a, b, c]: [Vec3; 3]) -> Option<Over> {
    let (first, second, from) = (b - a, c - a, point - a);
    let normal = first.cross(second);
    let squared_area = normal.length_squared();
    if squared_area < LEAST_AREA_SQUARED {
        return None;
    }
    let of_c = first.cross(from).dot(normal) / squared_area;
    let of_b = from.cross(second).dot(normal) / squared_area;
    let normal = normal / squared_area.sqrt();
    Some(Over { normal, height: from.dot(normal), coordinates: [1.0 - of_b - of_c, of_b, of_c] })
}
