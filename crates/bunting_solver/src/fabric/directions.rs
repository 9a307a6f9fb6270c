//! The directions of warp and weft in each triangle.

use glam::{Mat3, Vec2, Vec3};

use super::faces::Faces;
use super::links::along_u;

/// Least sine of the angle between a triangle's normal and a direction that is laid into its plane. Smaller: what is
/// left of a direction at right angles to the plane is rounding error, which may point out of it. Larger: more triangles
/// have another direction than their neighbours.
const LEAST_SINE: f32 = 0.1;

/// Least doubled area of a triangle in its texture, as a part of the square of its longest side there. Smaller: its
/// direction is rounding error.
const LEAST_TEXTURE: f32 = 1e-4;

/// The directions of warp and weft in each triangle, unit vectors in its plane at right angles to one another.
pub(in crate::fabric) struct Directions {
    warps: Vec<Vec3>,
    wefts: Vec<Vec3>,
}

impl Directions {
    pub fn of(faces: &Faces, corner_uv: &[[Vec2; 3]]) -> Self {
        Self::of_warps(faces, warps(faces, corner_uv))
    }

    /// Given the warp of each triangle.
    pub fn of_warps(faces: &Faces, warps: Vec<Vec3>) -> Self {
        let wefts = faces.normals.iter().zip(&warps).map(|(normal, &warp)| normal.cross(warp));
        Self { wefts: wefts.collect(), warps }
    }

    /// A direction in a triangle.
    pub fn of_triangle(&self, triangle: u32, towards: Towards) -> Vec3 {
        match towards {
            Towards::Warp => self.warps[triangle as usize],
            Towards::Weft => self.wefts[triangle as usize],
        }
    }
}

/// One of the two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fabric) enum Towards {
    Warp,
    Weft,
}

/// Unit vectors along the warp of each triangle.
///
/// A triangle with texture has the direction in which u grows. Others have the direction of a neighbour that has one,
/// laid into their plane. Of a mesh without texture the warp runs along the axis to which its normals are most nearly
/// at right angles, as the axis of a cylinder.
fn warps(faces: &Faces, corner_uv: &[[Vec2; 3]]) -> Vec<Vec3> {
    let mut warps: Vec<Vec3> = (0..faces.count() as u32)
        .map(|triangle| along_texture(faces.corners(triangle), corner_uv[triangle as usize]))
        .collect();
    if warps.iter().all(|warp| *warp == Vec3::ZERO) {
        let axis = axis(faces);
        for (warp, normal) in warps.iter_mut().zip(&faces.normals) {
            *warp = within(axis, *normal).unwrap_or_default();
        }
    }
    spread(faces, &mut warps);
    warps
}

/// The direction in which u grows; zero if the texture does not tell.
fn along_texture(corners: [Vec3; 3], uv: [Vec2; 3]) -> Vec3 {
    let (t1, t2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let longest = t1.length_squared().max(t2.length_squared());
    if t1.perp_dot(t2).abs() <= LEAST_TEXTURE * longest {
        return Vec3::ZERO;
    }
    along_u(corners, uv).unwrap_or_default()
}

/// The axis to which the normals, weighted by areas, are most nearly at right angles.
fn axis(faces: &Faces) -> Vec3 {
    let mut covariance = Mat3::ZERO;
    for (triangle, &normal) in faces.normals.iter().enumerate() {
        let [a, b, c] = faces.corners(triangle as u32);
        let area = (b - a).cross(c - a).length();
        covariance +=
            Mat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z) * area;
    }
    // The greatest eigenvalue of 1 − covariance/trace belongs to the least one of the covariance, and powers of the
    // matrix lead to its eigenvector.
    let trace = covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z;
    let mut power = Mat3::IDENTITY - covariance * (1.0 / trace);
    for _ in 0..SQUARINGS {
        power = power * power;
        let greatest = power.to_cols_array().into_iter().fold(0.0, f32::max);
        power *= 1.0 / greatest;
    }
    // Where two eigenvalues are alike any of their vectors will do; y is the vertical.
    let along = [Vec3::Y, Vec3::X, Vec3::Z].map(|axis| power * axis);
    let longest = |one: Vec3, other: Vec3| {
        if other.length_squared() > 1.01 * one.length_squared() { other } else { one }
    };
    along.into_iter().reduce(longest).unwrap_or(Vec3::Y).normalize_or(Vec3::Y)
}

/// Squarings of a matrix after which the ratio of eigenvalues that differ by a thousandth is above a thousand.
const SQUARINGS: u32 = 13;

/// Gives triangles without direction that of a neighbour, breadth first.
fn spread(faces: &Faces, warps: &mut [Vec3]) {
    let has = |warp: &Vec3| *warp != Vec3::ZERO;
    let mut front: Vec<u32> =
        (0..warps.len() as u32).filter(|&triangle| has(&warps[triangle as usize])).collect();
    let mut next_start = 0;
    loop {
        let mut at = 0;
        while at < front.len() {
            let from = front[at];
            for triangle in faces.neighbours(from) {
                if !has(&warps[triangle as usize]) {
                    let normal = faces.normals[triangle as usize];
                    warps[triangle as usize] = within(warps[from as usize], normal)
                        .unwrap_or_else(|| any_direction(faces, triangle));
                    front.push(triangle);
                }
            }
            at += 1;
        }
        // A piece of the mesh without any direction begins with one of its own.
        let Some(start) = (next_start..warps.len()).find(|&triangle| !has(&warps[triangle])) else {
            return;
        };
        warps[start] = any_direction(faces, start as u32);
        front = vec![start as u32];
        next_start = start + 1;
    }
}

/// A direction laid into the plane with a normal; none if it is nearly at right angles to the plane.
fn within(direction: Vec3, normal: Vec3) -> Option<Vec3> {
    let within = direction - normal * normal.dot(direction);
    (within.length() > LEAST_SINE).then(|| within.normalize())
}

fn any_direction(faces: &Faces, triangle: u32) -> Vec3 {
    let [a, b, _] = faces.corners(triangle);
    (b - a).normalize_or(Vec3::X)
}
