//! What strain leaves of the triangles of a surface: how far they are compressed and stretched, and how rough they lie.

mod condition;
mod roughness;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use glam::{DMat2, DVec2, DVec3, Vec2, Vec3};

use crate::simulation::in_double;
pub use condition::{COMPRESSED, Condition, Observed};
use roughness::Neighbours;

/// The triangles of a surface at rest, against which its positions are compared.
#[derive(Clone, Debug)]
pub struct Surface {
    triangles: Vec<Triangle>,
    /// The point of each vertex: the vertices of a seam are one point.
    points: Vec<usize>,
    neighbours: Neighbours,
    /// Roughness of the surface at rest, °.
    rest_roughness: f64,
}

/// A triangle at rest.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    /// Its vertices.
    corners: [usize; 3],
    /// Twice its area, m².
    doubled_area: f64,
    /// The inverse of its sides from the first corner, along warp and weft, 1/m.
    inverse_sides: DMat2,
}

impl Surface {
    /// The surface of triangles between vertices with positions at rest (m) and texture coordinates, whose u runs along the
    /// warp. Vertices at the same position at rest, to the bit, are one point.
    ///
    /// # Panics
    ///
    /// When a triangle has no area, at rest or in the texture.
    #[must_use]
    pub fn new(rest: &[Vec3], uv: &[Vec2], triangles: &[[u32; 3]]) -> Self {
        let mut numbers = HashMap::new();
        let number = |at: &Vec3| {
            let next = numbers.len();
            *numbers.entry(at.to_array().map(f32::to_bits)).or_insert(next)
        };
        let points: Vec<usize> = rest.iter().map(number).collect();
        let positions = in_double(rest);
        let corners = triangles.iter().map(|corners| corners.map(|at| at as usize));
        let of_points: Vec<[usize; 3]> =
            corners.clone().map(|corners| corners.map(|at| points[at])).collect();
        let mut surface = Self {
            triangles: corners.map(|corners| Triangle::new(corners, &positions, uv)).collect(),
            neighbours: Neighbours::new(&of_points),
            points,
            rest_roughness: 0.0,
        };
        surface.rest_roughness = surface.excess(&positions);
        surface
    }

    /// Area of each triangle over its area at rest.
    pub fn areas(&self, positions: &[DVec3]) -> impl Iterator<Item = f64> {
        self.triangles.iter().map(|triangle| {
            let [a, b] = triangle.sides(positions);
            a.cross(b).length() / triangle.doubled_area
        })
    }

    /// Strains along warp and weft of each triangle.
    pub fn strains(&self, positions: &[DVec3]) -> impl Iterator<Item = [f64; 2]> {
        self.triangles.iter().map(|triangle| {
            let [a, b] = triangle.sides(positions);
            let columns = triangle.inverse_sides.to_cols_array_2d();
            columns.map(|[of_a, of_b]| (a * of_a + b * of_b).length() - 1.0)
        })
    }

    /// How much further the normals of neighbouring triangles are apart, RMS, than after smoothing, beyond the same at
    /// rest, °. Folds of several triangles stay when smoothed; crumples of the size of a triangle go.
    #[must_use]
    pub fn roughness(&self, positions: &[DVec3]) -> f64 {
        (self.excess(positions) - self.rest_roughness).max(0.0)
    }

    fn excess(&self, positions: &[DVec3]) -> f64 {
        let mut of_points = vec![DVec3::ZERO; self.neighbours.points()];
        for (position, &point) in positions.iter().zip(&self.points) {
            of_points[point] = *position;
        }
        self.neighbours.turn(&of_points)
            - self.neighbours.turn(&self.neighbours.smoothed(&of_points))
    }
}

impl Triangle {
    fn new(corners: [usize; 3], rest: &[DVec3], uv: &[Vec2]) -> Self {
        let [a, b, c] = corners.map(|at| rest[at]);
        let [first, second, third] = corners.map(|at| uv[at].as_dvec2());
        let (sides, texture) = ([b - a, c - a], [second - first, third - first]);
        let doubled = sides[0].cross(sides[1]);
        let in_texture = texture[0].perp_dot(texture[1]);
        assert!(doubled.length() > 0.0 && in_texture != 0.0, "{corners:?} has no area");
        // The direction in which u grows and v does not.
        let warp = (sides[0] * texture[1].y - sides[1] * texture[0].y) / in_texture;
        let warp = warp.normalize();
        let weft = doubled.cross(warp).normalize();
        let along = |side: DVec3| DVec2::new(side.dot(warp), side.dot(weft));
        Self {
            corners,
            doubled_area: doubled.length(),
            inverse_sides: DMat2::from_cols(along(sides[0]), along(sides[1])).inverse(),
        }
    }

    /// Its sides from the first corner, m.
    fn sides(&self, positions: &[DVec3]) -> [DVec3; 2] {
        let [a, b, c] = self.corners.map(|at| positions[at]);
        [b - a, c - a]
    }
}
