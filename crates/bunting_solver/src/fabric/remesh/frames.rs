//! The directions of warp and weft at each vertex, alike up to quarter turns in all of its triangles.

use glam::{DQuat, DVec2, DVec3};

use crate::fabric::directions::{Directions, Towards};
use crate::fabric::faces::Faces;

/// Directions in the plane of the surface at a vertex: along warp or weft, at right angles to it, and along the normal; unit vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    axes: [DVec3; 2],
    normal: DVec3,
}

impl Frame {
    /// The axes after quarter turns about the normal.
    fn turned(&self, quarters: u8) -> [DVec3; 2] {
        let [x, y] = self.axes;
        match quarters % 4 {
            0 => [x, y],
            1 => [y, -x],
            2 => [-x, -y],
            _ => [-y, x],
        }
    }

    /// The quarter turns after which the axes of another vertex are nearest to those of this one.
    pub fn quarters_to(&self, other: &Self) -> u8 {
        let carried = DQuat::from_rotation_arc(self.normal, other.normal) * self.axes[0];
        let along = |quarters: &u8| other.turned(*quarters)[0].dot(carried);
        (0..4).max_by(|one, two| along(one).total_cmp(&along(two))).unwrap_or_default()
    }

    /// The vector to another vertex along the mean of the axes of both, as long as in space.
    pub fn vector_to(&self, other: &Self, quarters: u8, vector: DVec3) -> DVec2 {
        let [x, y] = self.axes;
        let [other_x, other_y] = other.turned(quarters);
        let along = DVec2::new(vector.dot(x + other_x), vector.dot(y + other_y));
        along.normalize_or_zero() * vector.length()
    }
}

/// The frame of each vertex, given its normal: the mean of the directions of its triangles, weighted by their areas, of which quarter turns are
/// alike, by the fourth power of complex numbers.
pub(super) fn frames(faces: &Faces, directions: &Directions, normals: &[DVec3]) -> Vec<Frame> {
    let across: Vec<DVec3> = normals.iter().map(|normal| normal.any_orthonormal_vector()).collect();
    let mut sums = vec![DVec2::ZERO; normals.len()];
    for triangle in 0..faces.count() as u32 {
        let warp = directions.of_triangle(triangle, Towards::Warp).as_dvec3();
        let [a, b, c] = faces.corners(triangle).map(|corner| corner.as_dvec3());
        let area = (b - a).cross(c - a).length();
        for vertex in faces.particles(triangle) {
            let vertex = vertex as usize;
            let (x, y) = (across[vertex], normals[vertex].cross(across[vertex]));
            let once = DVec2::new(warp.dot(x), warp.dot(y)).normalize_or_zero();
            let twice = once.rotate(once);
            sums[vertex] += area * twice.rotate(twice);
        }
    }
    let frame = |((&normal, &x), sum): ((&DVec3, &DVec3), &DVec2)| {
        let angle = 0.25 * libm::atan2(sum.y, sum.x);
        let (sin, cos) = libm::sincos(angle);
        let axis = x * cos + normal.cross(x) * sin;
        Frame { axes: [axis, normal.cross(axis)], normal }
    };
    normals.iter().zip(&across).zip(&sums).map(frame).collect()
}

/// Coordinates along axes that make quarter turns to become those given.
pub(super) fn turned(DVec2 { x, y }: DVec2, quarters: u8) -> DVec2 {
    match quarters % 4 {
        0 => DVec2::new(x, y),
        1 => DVec2::new(y, -x),
        2 => DVec2::new(-x, -y),
        _ => DVec2::new(-y, x),
    }
}
