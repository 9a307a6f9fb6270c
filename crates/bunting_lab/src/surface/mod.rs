//! What strain leaves of the triangles of a surface: how far they are compressed, and how rough they lie.

mod condition;
mod roughness;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::simulation::in_double;
pub use condition::{Condition, Observed};
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
}

impl Surface {
    /// The surface of triangles between vertices with positions at rest, m. Vertices at the same position at rest, to the bit,
    /// are one point.
    ///
    /// # Panics
    ///
    /// When a triangle has no area.
    #[must_use]
    pub fn new(rest: &[Vec3], triangles: &[[u32; 3]]) -> Self {
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
            triangles: corners.map(|corners| Triangle::new(corners, &positions)).collect(),
            neighbours: Neighbours::new(&of_points),
            points,
            rest_roughness: 0.0,
        };
        surface.rest_roughness = surface.excess(&positions);
        surface
    }

    /// Area of each triangle over its area at rest.
    pub fn areas(&self, positions: &[DVec3]) -> impl Iterator<Item = f64> {
        self.triangles
            .iter()
            .map(|&Triangle { corners, doubled_area }| doubled(corners, positions) / doubled_area)
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
    fn new(corners: [usize; 3], rest: &[DVec3]) -> Self {
        let doubled_area = doubled(corners, rest);
        assert!(doubled_area > 0.0, "{corners:?} has no area");
        Self { corners, doubled_area }
    }
}

/// Twice the area of the triangle of these vertices, m².
fn doubled(corners: [usize; 3], positions: &[DVec3]) -> f64 {
    let [a, b, c] = corners.map(|at| positions[at]);
    (b - a).cross(c - a).length()
}
